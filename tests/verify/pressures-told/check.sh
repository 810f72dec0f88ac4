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

# a block that tips stands on one point of a straight side
silent edge W-FEW-POINTS block.inp
near 'on its edge' "$(awk '!/^#/ && $8 > 0' edge/contact.tab | wc -l)" 1 0

told rings 'IN-RIGHT on OUT-LEFT: the pressure goes up and down from point to point' rings.inp
silent alike W-ALTERNATES rings.inp --set n=19
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
