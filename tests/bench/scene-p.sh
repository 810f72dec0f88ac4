#!/bin/sh
# Prints the deck of scene P: a block 1.0 x 0.5 is pressed on a block 2.0 x 1.0 and pushed aside; conforming squares. Every point
# of the contact line is active.
#    tests/bench/scene-p.sh N [PRINTED]      elements of side 1/N, N even; N = 20, 44, 100, 200, 446 have 2e3 to 1e6 dofs
# PRINTED: `all` prints displacements, reactions and stresses of everything (default), `line` of the contact line alone.
set -eu
n=${1:?"usage: scene-p.sh N [all|line]"}
printed=${2:-all}
cat <<deck
*HEADING
Scene P, elements of 1/$n
*BLOCK, TYPE=CPE4, ELSET=LOWER, NX=$((2*n)), NY=$n
0., 0.
2., 0.
2., 1.
0., 1.
*BLOCK, TYPE=CPE4, ELSET=UPPER, NX=$n, NY=$((n/2))
.5, 1.
1.5, 1.
1.5, 1.5
.5, 1.5
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
*FRICTION, NONLOCAL
.3, 1e-7, .01
*CONTACT PAIR, INTERACTION=JOINT
UPPER-BOTTOM, LOWER-TOP
*BOUNDARY
LOWER-BOTTOM, 1, 2
*STEP
*STATIC
*BOUNDARY
UPPER-TOP, 2, 2, -.01
UPPER-TOP, 1, 1, .007
deck
if [ "$printed" = all ]; then
   printf '*NODE PRINT\nU, RF\n*EL PRINT\nS\n'
else
   printf '*NODE PRINT, NSET=UPPER-BOTTOM\nU\n'
fi
printf '*CONTACT PRINT\n*END STEP\n'
