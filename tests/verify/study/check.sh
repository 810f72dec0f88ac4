. "$(dirname "$0")/../lib.sh"
pillar=$input/ex3-pillar-in-ground.inp
# value_of LEVEL ELEMENT COLUMN of study.tab
value_of() {
   awk -v level="$1" -v element="$2" -v name="$3" '/^# columns:/ { for (i = 3; i <= NF; i++) c[$i] = i - 2; next }
      !/^#/ && $1 == level && $2 == element { print $c[name] }' out/study.tab
}
"$atrito" study "$pillar" --levels 3 --elements cps4,cps9 --reference strain_energy --reference normal_resultant=2.8e5 -o out \
   --digits 17 >said 2>told || complain "study: exit $?"
near 'rows' "$(grep -vc '^#' out/study.tab)" 6 0
# A level is the deck with --refine; the elements of the deck are those of the deck.
for level in 0 1 2; do
   run 0 "$pillar" "level-$level" --refine $level --digits 17 --quiet
   for quantity in strain_energy normal_resultant error_estimate_percent; do
      near "cps9, level $level, $quantity" "$(value_of $level cps9 $quantity)" "$(summary level-$level $quantity)" 0
   done
   "$atrito" compare "level-$level" "out/cps9_$level" --rtol 0 >/dev/null || complain "level $level: other tables"
done
# Four-node elements on the same nodes: as many displacements, half the size, more energy of a body whose motion is prescribed.
near 'dofs of cps4' "$(value_of 2 cps4 dofs)" "$(value_of 2 cps9 dofs)" 0
near 'size of cps4' "$(value_of 2 cps4 h)" "$(awk -v h="$(value_of 2 cps9 h)" 'BEGIN { printf "%.17g", h/2 }')" 1e-14
awk -v a="$(value_of 2 cps4 strain_energy)" -v b="$(value_of 2 cps9 strain_energy)" 'BEGIN { exit !(a > b) }' ||
   complain 'cps4 is softer than cps9'
# Errors are against the given value, or the limit.
near 'error against a given value' "$(value_of 1 cps9 normal_resultant_error)" \
   "$(awk -v v="$(value_of 1 cps9 normal_resultant)" 'BEGIN { printf "%.17g", (v - 2.8e5)/2.8e5 }')" 1e-14
says 'reference' said 'extrapolated from cps9'
says 'reference' out/study.tab '# normal_resultant: reference 280000, given'
says 'singular pressure' said 'the largest pressure grows with every level'

# Nine-node elements from four-node ones: the same as a deck of them.
sed 's/CPE4/CPE9/' "$input/ex1-plate-on-rigid-support.inp" >nine.inp
run 0 nine.inp nine --digits 17 --quiet
"$atrito" study "$input/ex1-plate-on-rigid-support.inp" --levels 1 --elements cpe9 -o other --digits 17 --quiet || complain 'cpe9 of a deck of cpe4'
same_tables 'contact of cpe9' nine/contact.tab other/cpe9_0/contact.tab 1e-9
near 'energy of cpe9' "$(summary other/cpe9_0 strain_energy)" "$(summary nine strain_energy)" 1e-13

# A body without contact: what belongs to a pair is nan.
sed -e '/^\*SURFACE, NAME=SUPPORT/,/^OVER-BOTTOM, SUPPORT/d' -e '/^\*CONTACT PRINT/d' -e 's/^SPAN-RIGHT, 1/&\nOVER-BOTTOM, 2/' \
   "$input/ex1-plate-on-rigid-support.inp" >lone.inp
"$atrito" study lone.inp --levels 3 -o lone --quiet --plot || complain 'a study of a body without contact'
near 'resultant of no pair' "$(grep -c 'normal_resultant: no limit' lone/study.tab)" 1 0

# Faults are told before anything is written.
for fault in '--levels 2 --elements cpe4' '--levels 2 --reference energy' '--levels 2 --reference strain_energy=x' '--elements cps4'; do
   # shellcheck disable=SC2086
   "$atrito" study "$pillar" $fault -o wrong >/dev/null 2>told
   near "$fault" $? 1 0
   absent wrong
done
finish
