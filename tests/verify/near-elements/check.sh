#!/bin/sh
# Elements that are equal but for the last printed digits share their fronts, and the results do not tell.
. "$(dirname "$0")/../lib.sh"
bench=$here/../../bench

# fronts FOLDER: how many of the fronts of the lower body differ.
fronts() {
   sed -n 's/.*LOWER: [0-9]* fronts, \([0-9]*\) of them different.*/\1/p' "$1"/*.lst
}

# same_results WHAT A B [TOLERANCE]
same_results() {
   for table in nodes reactions contact; do
      same_tables "$1, $table" "$2/$table.tab" "$3/$table.tab" "${4:-1e-12}"
   done
   same_tables "$1, stress" "$2/stress.tab" "$3/stress.tab" 1e-11
}

words='elements that differ in the last printed digits'

sh "$bench/explicit-deck.sh" 22 17 | sed 's/^\*STATIC/&\n*CONTROLS, TOLERANCE=1e-13/' >all-digits.inp
run 0 all-digits.inp all-digits --quiet --solver sparse
[ "$(fronts all-digits)" -gt 10 ] || complain 'the listing does not tell the fronts'
grep -qF "$words" all-digits/all-digits.lst && complain '17 digits: equal elements are not told to be equal'
for digits in 10 12 14; do
   sh "$bench/explicit-deck.sh" 22 $digits | sed 's/^\*STATIC/&\n*CONTROLS, TOLERANCE=1e-13/' >$digits.inp
   run 0 $digits.inp own-$digits --quiet --solver skyline --digits 17
   run 0 $digits.inp shared-$digits --quiet --solver sparse --digits 17
   [ "$(fronts shared-$digits)" = "$(fronts all-digits)" ] || complain "$digits digits: $(fronts shared-$digits) fronts differ"
   says "$digits digits" shared-$digits/$digits.lst "$words"
   below "$digits digits, equilibrium" "$(summary shared-$digits equilibrium_residual)" 1e-12
   same_results "$digits digits" shared-$digits own-$digits
done
run 0 12.inp sparse-form --quiet --contact sparse --digits 17
says 'sparse form' sparse-form/12.lst "$words"
below 'sparse form, equilibrium' "$(summary sparse-form equilibrium_residual)" 1e-12
same_results 'sparse form' sparse-form own-12 1e-11

# The third run of a sweep takes the bodies of the first.
sed 's/^\*HEADING/*PARAMETER\nNU = .3\n&/; s/^\.3, 1e-7, \.01/<NU>, 1e-7, .01/' 12.inp >swept.inp
rm -rf swept
"$atrito" sweep swept.inp --vary NU=.2,.25,.3 -o swept --quiet --solver sparse --digits 17 >swept.out 2>&1 || complain "sweep: exit $?"
last=$(find swept -name nodes.tab | sort | tail -1)
same_results 'sweep' "$(dirname "$last")" own-12

# A strip of 400 x 1, turned by half a radian.
awk 'BEGIN {
   n = 400; m = 4; c = cos(.5); s = sin(.5)
   print "*NODE"
   for (j = 0; j <= m; j++)
      for (i = 0; i <= n; i++) printf "%d, %.10g, %.10g\n", ++node, c*i - s*j/m, s*i + c*j/m
   print "*ELEMENT, TYPE=CPE4, ELSET=STRIP"
   for (j = 0; j < m; j++)
      for (i = 0; i < n; i++) { k = j*(n + 1) + i + 1; printf "%d, %d, %d, %d, %d\n", ++e, k, k + 1, k + n + 2, k + n + 1 }
   printf "*NSET, NSET=FOOT, GENERATE\n1, %d, %d\n*NSET, NSET=TIP\n%d\n", m*(n + 1) + 1, n + 1, n + 1
   print "*MATERIAL, NAME=M\n*ELASTIC\n1000., .3\n*SOLID SECTION, ELSET=STRIP, MATERIAL=M\n1."
   print "*BOUNDARY\nFOOT, 1, 2\n*STEP\n*STATIC\n*CLOAD\nTIP, 2, 1e-6\n*NODE PRINT\nU\n*END STEP" }' >strip.inp
run 0 strip.inp strip --solver sparse --digits 17 --progress all
grep -qF 'each element with its own last digits' strip.out strip.err || complain 'strip: refined in spite of its slenderness'
grep -qF "$words" strip/strip.lst && complain 'strip: the listing tells of a refinement'
run 0 strip.inp strip-own --quiet --solver skyline --digits 17
same_tables 'strip' strip/nodes.tab strip-own/nodes.tab 1e-5
finish
