. "$(dirname "$0")/../lib.sh"
run 0 "$here/plate.inp" m --digits 17 --quiet
compare_with() { # NAME L F: the same in other units
   run 0 "$here/plate.inp" "$1" --digits 17 --quiet --set L="$2" --set F="$3"
   l=$2
   s=$(awk -v l="$2" -v f="$3" 'BEGIN { printf "%.17g", f/l/l }')
   a=$(awk -v l="$2" 'BEGIN { printf "%.17g", l*l }')
   e=$(awk -v l="$2" -v f="$3" 'BEGIN { printf "%.17g", l*f }')
   same_tables "$1 contact" m/contact.tab "$1/contact.tab" 1e-12 s=$l x=$l y=$l gap=$l slip=$l slip_increment=$l pressure=$s \
      weighted_pressure=$s shear=$s weight=$a
   same_tables "$1 nodes" m/nodes.tab "$1/nodes.tab" 1e-12 x=$l y=$l u1=$l u2=$l
   same_tables "$1 reactions" m/reactions.tab "$1/reactions.tab" 1e-12 r1=$3 r2=$3
   same_tables "$1 stress" m/stress.tab "$1/stress.tab" 1e-12 x=$l y=$l s11=$s s22=$s s33=$s s12=$s mises=$s s1=$s s2=$s
   for t in m "$1"; do # the counts of the iterations; the residuals at the end are round-off
      awk '!/^#/ { print $2, $3, $7, $8, $9 }' $t/iterations.tab >"$t.counts"
   done
   cmp m.counts "$1.counts" || complain "$1: other iterations"
   near "$1 energy" "$(summary "$1" strain_energy)" "$(awk -v a="$(summary m strain_energy)" -v e="$e" 'BEGIN { printf "%.17g", a*e }')" \
      "$(awk -v a="$(summary "$1" strain_energy)" 'BEGIN { printf "%.17g", 1e-12*a }')"
}
compare_with mm 1e3 1e3
compare_with Gm 1e-9 1
compare_with far 1e-9 1e9
compare_with um 1e6 1e9
compare_with um-GN 1e6 1e-6
# the principal stresses are the ends of Mohr's circle
awk '!/^#/ { d = ($6 - $7)/2; m = ($6 + $7)/2; r = sqrt(d*d + $9*$9); size = sqrt($6*$6 + $7*$7 + $9*$9)
             if ($11 < $12 || ($11 - m - r)^2 + ($12 - m + r)^2 > (1e-12*size)^2) { print; bad = 1 } } END { exit bad || NR < 400 }' m/stress.tab ||
   complain 'principal stresses'
# names of units: on the screen, in the listing and in pictures of a run, not in its tables
{ echo '*UNITS'; echo 'm, kN'; cat "$here/plate.inp"; } >named.inp
mkdir -p none
printf '#!/bin/sh\n' >none/gnuplot               # the scripts alone are looked at
chmod +x none/gnuplot
PATH=$PWD/none:$PATH run 0 named.inp named --plot
for file in named.out named/named.lst named/plots/contour-mises.gp named/plots/mesh.gp named/plots/contact-1.gp; do
   sed '/THE DECK/,/^1 /d' $file >shown
   grep -q '\[k\{0,1\}[mN][] /]' shown || complain "$file: no unit has its name"
   grep '\[[FL]' shown && complain "$file: a unit without its name"
done
grep -q '^# dimensions:.* F/L^2' named/contact.tab || complain 'contact.tab: the dimensions'
finish
