#!/bin/sh
# A contact line of many points: coarse start against plain start, any number of threads.
. "$(dirname "$0")/../lib.sh"
# blocks NAME METHOD FRICTION TOP: a block 1.04 x .5 on one of 2 x 1, pressed; FRICTION is the card with its data or nothing; TOP is
# how far its top is moved along x.
blocks() {
   cat >"$1.inp" <<END
*HEADING
$1
*BLOCK, TYPE=CPE4, ELSET=LOWER, NX=500, NY=6
0., 0.
2., 0.
2., 1.
0., 1.
GRADE, 1., .02
*BLOCK, TYPE=CPE4, ELSET=UPPER, NX=260, NY=6
.48, 1.
1.52, 1.
1.52, 1.5
.48, 1.5
GRADE, 1., 30.
*MATERIAL, NAME=STONE
*ELASTIC
1000., .3
*SOLID SECTION, ELSET=LOWER, MATERIAL=STONE
1.
*SOLID SECTION, ELSET=UPPER, MATERIAL=STONE
1.
*SURFACE INTERACTION, NAME=JOINT
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR
1e7
$3
*CONTACT PAIR, INTERACTION=JOINT
UPPER-BOTTOM, LOWER-TOP
*BOUNDARY
LOWER-BOTTOM, 1, 2
*STEP
*STATIC
*CONTROLS, METHOD=$2
*BOUNDARY
UPPER-TOP, 2, 2, -.01
UPPER-TOP, 1, 1, $4
*NODE PRINT, NSET=UPPER-BOTTOM
U
*CONTACT PRINT
*END STEP
END
}
friction='*FRICTION, NONLOCAL
.3, 1e-7, .01'
blocks plain PICARD "$friction" .007
blocks coarse ANDERSON "$friction" .007
run 0 plain.inp plain --quiet
run 0 coarse.inp coarse --quiet
same_tables "contact points" plain/contact.tab coarse/contact.tab 1e-9
[ "$(summary coarse stick_points)" -gt 50 ] && [ "$(summary coarse slip_points)" -gt 50 ] || complain "stick and slip expected"
echo "solves: $(summary plain linear_solves) from a plain start, $(summary coarse linear_solves) from a coarse one"
[ "$(summary coarse linear_solves)" -lt "$(summary plain linear_solves)" ] || complain "the coarse start does not pay"
run 0 coarse.inp threads --quiet --threads 3 --digits 17
run 0 coarse.inp one-thread --quiet --digits 17
for table in contact iterations nodes summary; do
   grep -v -e seconds -e memory one-thread/$table.tab >one.txt
   grep -v -e seconds -e memory threads/$table.tab | cmp -s one.txt - || complain "$table.tab depends on the number of threads"
done
blocks smooth ANDERSON '' .007
run 0 smooth.inp smooth --quiet
near "solves without friction" "$(summary smooth linear_solves)" 1 0
finish
