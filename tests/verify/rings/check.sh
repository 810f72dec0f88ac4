# check.sh ATRITO CASE_FOLDER INPUT_FOLDER ERROR_NORMS
. "$(dirname "$0")/../lib.sh"
errors=$4
mesh=$here/../mesh.awk
. "$here/../convergence/rates.sh"
rm -f rings.txt pressure.txt
d=1e-3
c=$(value "1.5 - $d")

# closed form: the pressure on the inner ring.
p=$(awk -v d=$d '
   function u(e, mu, a, b, inside, outside, r,   k) {      # plane strain; displacement of a ring at r
      e = e/(1 - mu*mu); mu = mu/(1 - mu); k = b*b - a*a
      return ((1 - mu)*(inside*a*a - outside*b*b)*r + (1 + mu)*(inside - outside)*a*a*b*b/r)/(e*k)
   }
   BEGIN { c = 1.5 - d; printf "%.17g", d/(u(2000, 0.2, c, 2, 1.5/c, 0, c) - u(1000, 0.3, 1, 1.5, 0, 1, 1.5)) }' </dev/null)

# supports ELSET FIRST TYPE N M: where the axes cut a closed ring.
supports() {
   awk -v first="$2" -v type="$3" -v n="$4" -v m="$5" 'BEGIN {
      order = (type ~ /9/) ? 2 : 1
      for (q = 0; q < 4; q++) print first + order*m/4*q*(order*n + 1) + 1 ", " ((q % 2) ? 1 : 2) }' </dev/null
}

# rings TYPE N SLAVE TURN: N elements along the radius of each ring.
rings() {
   m=$(($2*$4/45))
   printf '*HEADING\nShrink fit\n'
   awk -v type="$1" -v n="$2" -v m=$m -v map=ring -v r1=1 -v r2=1.5 -v turn="$4" -v elset=IN -f "$mesh"
   awk -v type="$1" -v n="$2" -v m=$m -v map=ring -v r1="$c" -v r2=2 -v turn="$4" -v elset=OUT -v first=100000 -f "$mesh"
   echo "*MATERIAL, NAME=A
*ELASTIC
1000, 0.3
*MATERIAL, NAME=B
*ELASTIC
2000, 0.2
*SOLID SECTION, ELSET=IN, MATERIAL=A
*SOLID SECTION, ELSET=OUT, MATERIAL=B
*SURFACE INTERACTION, NAME=JOINT
*CONTACT PAIR, INTERACTION=JOINT, QUADRATURE=NODAL"
   if [ "$3" = in ]; then echo "IN-RIGHT, OUT-LEFT"; else echo "OUT-LEFT, IN-RIGHT"; fi
   echo "*BOUNDARY"
   if [ "$4" = 360 ]; then
      supports IN 0 "$1" "$2" $m
      supports OUT 100000 "$1" "$2" $m
   else
      printf 'IN-BOTTOM, 2\nOUT-BOTTOM, 2\nIN-TOP, 1\nOUT-TOP, 1\n'
   fi
   printf '*STEP\n*STATIC\n*NODE PRINT\nU\n*END STEP\n'
}

# worst TABLE P: largest relative error of the pressure.
worst() {
   column "$1" pressure | awk -v p="$2" '{ d = $1/p - 1; if (d < 0) d = -d; if (d > most) most = d } END { printf "%.17g", (NR > 0) ? most : 9 }'
}

for type in CPE4 CPE9; do
   case $type in *4) l2=2 energy=1 ;; *) l2=3 energy=2 ;; esac
   for slave in in out; do
      for turn in 90 360; do
         name=${type}_${slave}_${turn}
         q=$p
         [ $slave = out ] && q=$(value "$p*1.5/$c")
         before=0
         for n in 2 4 8; do
            rings $type $n $slave $turn >$name-$n.inp
            run 0 $name-$n.inp $name-$n --digits 17
            grep -q LEFT-OUT $name-$n.err && complain "$name-$n: faces are left out"
            all_near "$name-$n gap" $name-$n/contact.tab gap 0 1e-17
            row rings.txt $name 0 $name-$n.inp rings 1 1.5 "$c" 2 "$p"
            now=$(worst $name-$n/contact.tab "$q")
            echo "$name $n $now" >>pressure.txt
            order=$(value "$before > 0 ? log($before/$now)/log(2) : 0")
            before=$now
         done
         orders rings.txt $name $l2 $energy
         near "$name: order of the pressure" "$order" $l2 0.1
      done
   done
done
below 'pressure, nine nodes, 8 elements along the radius' "$(worst CPE9_in_360-8/contact.tab "$p")" 1e-5

for name in CPE4_in_90 CPE9_in_90 CPE9_in_360 CPE9_out_360; do
   sed 's/, QUADRATURE=NODAL//' $name-4.inp >$name-default.inp
   run 0 $name-default.inp $name-default --digits 17 --quiet
   same_tables "$name, quadrature by default" $name-default/contact.tab $name-4/contact.tab 0
done

# A rigid disc in a ring: u(1) = d.
{ printf '*HEADING\nDisc\n'
  awk -v type=CPE9 -v n=4 -v m=8 -v map=ring -v r1=1 -v r2=2 -v turn=90 -f "$mesh"
  awk -v d=$d 'BEGIN { r = 1 + d; pi = atan2(0, -1)
     print "*SURFACE, NAME=DISC, TYPE=SEGMENTS"
     printf "START, %.17g, %.17g\n", r*cos(pi/2 + 0.1), r*sin(pi/2 + 0.1)
     printf "CIRCL, %.17g, %.17g, 0, 0\n", r*cos(-0.1), r*sin(-0.1) }' </dev/null
  echo "*RIGID BODY, ANALYTICAL SURFACE=DISC
*MATERIAL, NAME=A
*ELASTIC
1000, 0.3
*SOLID SECTION, ELSET=ALL, MATERIAL=A
*SURFACE INTERACTION, NAME=JOINT
*CONTACT PAIR, INTERACTION=JOINT
ALL-LEFT, DISC
*BOUNDARY
ALL-BOTTOM, 2
ALL-TOP, 1
*STEP
*STATIC
*NODE PRINT
U
*END STEP"; } >disc.inp
run 0 disc.inp disc --digits 17 --quiet
# plane strain: u(1) = (1 + mu)/E (1 - 2 mu + b^2) p/(b^2 - 1)
disc=$(value "$d*1000*3/1.3/(0.4 + 4)")
# the rings have 6e-5 with as many elements along the radius
near 'disc: pressure' "$(worst disc/contact.tab "$disc")" 0 2e-4
echo
markdown rings.txt
echo
awk 'function order(before, now) { return (before > 0) ? sprintf("%.2f", log(before/now)/log(2)) : "" }
   BEGIN { print "| rings | elements along the radius of each | largest error of the pressure | order |\n|---|---|---|---|" }
   { if ($1 != name) before = 0; text = $1; gsub(/_/, " ", text)
     printf "| %s | %d | %.3e | %s |\n", text, $2, $3, order(before, $3); name = $1; before = $3 }' pressure.txt

# Rings whose nodes do not match, either ring the slave: the force on the joint of a quarter, against Lame and each other.
# force TYPE N M N M SLAVE
force() {
   { printf '*HEADING\nPress fit\n'
     awk -v type="$1" -v n="$2" -v m="$3" -v map=ring -v r1=1 -v r2=1.5 -v turn=90 -v elset=IN -f "$mesh"
     awk -v type="$1" -v n="$4" -v m="$5" -v map=ring -v r1="$c" -v r2=2 -v turn=90 -v elset=OUT -v first=100000 -f "$mesh"
     rings "$1" 2 "$6" 90 | sed -n '/^\*MATERIAL, NAME=A/,$p' | sed 's/, QUADRATURE=NODAL//'; } >press.inp
   run 0 press.inp press --digits 17 --quiet
   awk '/^# columns:/ { for (i = 3; i <= NF; i++) at[$i] = i - 2 } !/^#/ { sum += $at["pressure"]*$at["weight"] }
      END { printf "%.17g", sum }' press/contact.tab
}
wanted=$(value "$p*1.5*2*atan2(1, 1)")
for case in 'CPE4 3 24 2 36' 'CPE4 6 48 4 36' 'CPE4 4 24 4 25' 'CPE9 2 8 2 11'; do
   in=$(force $case in)
   out=$(force $case out)
   near "$case: force" "$in" "$wanted" "$(value "0.005*$wanted")"
   near "$case: force of either role" "$in" "$out" "$(value "0.001*$wanted")"
done
finish
