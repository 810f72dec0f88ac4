. "$(dirname "$0")/../lib.sh"
cp "$here"/*.inp .
# told NAME TEXT DECK OPTIONS, silent NAME ID DECK OPTIONS
told() {
   name=$1 text=$2 deck=$3
   shift 3
   run 0 "$deck" "$name" "$@"
   says "$name" "$name.err" "$text"
}
silent() {
   name=$1 id=$2 deck=$3
   shift 3
   run 0 "$deck" "$name" "$@"
   ! grep -q "$id" "$name.err" || { complain "$name: $id"; cat "$name.err"; }
}

told one 'CAP-BOTTOM on FLOOR: sides that curve apart touch at 1 point only, round node 226 (0, 0)' disc.inp
says one one.err 'Faces there of 1/7 of their length'
told three 'touch at 3 points only' disc.inp --set F=3000
grep -Eq 'the energy and these works [.]+ agree to [0-9.]+e-1[0-9] ' three/disc.lst || complain 'three: the energies do not agree'
told five 'touch at 5 points only' disc.inp --set F=7000 --set n=16
silent seven W-FEW-POINTS disc.inp --set F=60000 --set n=16
hertz=$(awk 'BEGIN { print sqrt(60000*210000/0.91/(10*atan2(0, -1))) }' </dev/null)
near 'seven points' "$(summary seven max_pressure)" "$hertz" "$(awk "BEGIN { print 0.05*$hertz }" </dev/null)"
sed 's/CPE8/CPE4/' disc.inp >linear.inp
told linear 'touch at 3 points only' linear.inp --set F=30000
silent linear-5 W-FEW-POINTS linear.inp --set F=30000 --set n=16

# a fine disc on coarse ground: the finer slave takes what the ground cannot follow
awk '/^\*SURFACE, NAME=FLOOR/ { print "*BLOCK, TYPE=CPE4, ELSET=GROUND, NX=<m>, NY=<m>\n0, -20\n20, -20\n20, 0\n0, 0\n" \
      "*SOLID SECTION, ELSET=GROUND, MATERIAL=STEEL"; n = 4 }
   n > 0 { n--; next }
   { print }
   /^\*PARAMETER/ { print "m = 6" }
   /^\*BOUNDARY/ { print "GROUND-BOTTOM, 1, 2\nGROUND-LEFT, 1" }' linear.inp | sed 's/, FLOOR/, GROUND-TOP/' >ground.inp
told ground 'over hardly 2 distances of the nodes of GROUND-TOP, which cannot follow the finer slave' ground.inp \
   --set F=60000 --set n=16
hertz=$(awk 'BEGIN { print sqrt(60000*105000/0.91/(10*atan2(0, -1))) }' </dev/null)
below 'coarse ground: too large by more than' 0.2 "$(awk -v p="$(summary ground max_pressure)" "BEGIN { print p/$hertz - 1 }" </dev/null)"
silent fine-ground W-FEW-POINTS ground.inp --set F=60000 --set n=16 --set m=40
near 'fine ground' "$(summary fine-ground max_pressure)" "$hertz" "$(awk "BEGIN { print 0.05*$hertz }" </dev/null)"

# a block that tips stands on one point of a straight side
silent edge W-FEW-POINTS block.inp
near 'on its edge' "$(awk '!/^#/ && $8 > 0' edge/contact.tab | wc -l)" 1 0

told rings 'IN-RIGHT on OUT-LEFT: the pressure goes up and down from point to point' rings.inp
silent alike W-ALTERNATES rings.inp --set n=19
# rings alike: the faces of the master are straight where the side is curved, and the finer slave would follow them
sed 's/^20000, 0.2/100, 0.3/; s/, QUADRATURE=NODAL//' rings.inp >polygon.inp
told polygon 'the slave IN-RIGHT is 4 times as fine as the curved side OUT-LEFT, whose faces are straight' polygon.inp --set m=8
lame=$(awk 'BEGIN { e = 100/0.91; mu = 3/7; print 0.03*e/(3*((9 + 2.89)/(9 - 2.89) - mu + (25 + 9)/(25 - 9) + mu)) }' </dev/null)
all_near polygon polygon/contact.tab pressure "$lame" "$(awk "BEGIN { print 0.01*$lame }" </dev/null)"
sed 's/^20000, 0.2/100, 0.3/' rings.inp >nodal.inp
told nodal 'pressures on it follow the corners between those faces' nodal.inp --set m=8
sed 's/^IN-RIGHT, OUT-LEFT/OUT-LEFT, IN-RIGHT/; s/SLAVE=IN-RIGHT, MASTER=OUT-LEFT/SLAVE=OUT-LEFT, MASTER=IN-RIGHT/' nodal.inp >coarse.inp
told coarse 'W-COARSE-SLAVE' coarse.inp --set m=8
! grep -q 'finer side as slave' coarse.err || complain 'the finer side is recommended on a polygon'

told loose 'a pair that never closes: IN-RIGHT on OUT-LEFT' rings.inp --set gap=0.03 --set push=0.01
silent nothing N-OPEN rings.inp --set gap=0.03
sed 's/^IN-RIGHT, OUT-LEFT/&\nOUT-LEFT, IN-RIGHT/; /CLEARANCE/d' rings.inp >twice.inp
told twice 'IN-RIGHT on OUT-LEFT and OUT-LEFT on IN-RIGHT: the same faces face each other in both pairs' twice.inp --set push=1
says twice twice.err 'one of them, OUT-LEFT on IN-RIGHT, whose slave is the softer side'
told wedge 'W-LEFT on LEFT carries forces of 250 [F], more than a hundred times' wedge.inp
near 'the wedge' "$(summary wedge normal_resultant | head -1)" 250.0005 1e-3
silent blunt W-WEDGE wedge.inp --set s=0.02
# loads whose squares are no numbers
sed 's:^W-TOP, P, <:&1e-250*:' wedge.inp >tiny.inp
told 'tiny wedge' 'W-LEFT on LEFT carries forces of 2.5e-248 [F], more than a hundred times' tiny.inp
silent 'tiny blunt' W-WEDGE tiny.inp --set s=0.02
finish
