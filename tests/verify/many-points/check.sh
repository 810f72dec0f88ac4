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

# strips FILE N M: a strip of N faces on a strip of M.
strips() {
   echo "*BLOCK, TYPE=CPE4, ELSET=LOW, NX=$3, NY=2
0., 0.
10., 0.
10., 1.
0., 1.
*BLOCK, TYPE=CPE4, ELSET=UP, NX=$2, NY=2
0., 1.
10., 1.
10., 2.
0., 2.
*MATERIAL, NAME=M
*ELASTIC
1000., 0.
*SOLID SECTION, ELSET=LOW, MATERIAL=M
*SOLID SECTION, ELSET=UP, MATERIAL=M
*SURFACE INTERACTION, NAME=I
*CONTACT PAIR, INTERACTION=I
UP-BOTTOM, LOW-TOP
*BOUNDARY
LOW-BOTTOM, 1, 2
UP-LEFT, 1
*STEP
*STATIC
*DSLOAD
UP-TOP, P, 1.
*END STEP" >"$1"
}
# what a scene of 3,000 points on one face holds in memory: 24 MiB; 284 with that face as a neighbour of everything
predicted() {
   sed -n 's/.*memory, predicted \.* \([0-9.]*\) MiB/\1/p' "$1/$1.lst"
}
strips one-face.inp 3000 1
run 0 one-face.inp one-face --quiet
below "memory of 3,000 points on a face" "$(predicted one-face)" 50
all_near "pressure of 3,000 points on a face" one-face/contact.tab pressure 1 1e-9
# a finer master: its nodes count, too (66 s and 4.9 GB in the dense form)
strips finer.inp 300 3000
run 0 finer.inp finer --quiet
says "300 points on 3,000 faces" finer/finer.lst 'sparse, predicted cost'
all_near "pressure of 300 points on 3,000 faces" finer/contact.tab pressure 1 1e-9
finish
