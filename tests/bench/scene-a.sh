#!/bin/sh
# Prints the deck of scene A: a plate 3.2 x 0.6 lies on the left on a block 0.6 x 0.5 and is pressed down; conforming squares.
#    tests/bench/scene-a.sh K [PRINTED]      elements of side 0.1/K; K = 2, 5, 11, 21, 47 have 2e3 to 1e6 dofs
# PRINTED: `all` prints displacements, reactions and stresses of everything (default), `line` of the contact line alone.
set -eu
k=${1:?"usage: scene-a.sh K [all|line]"}
printed=${2:-all}
cat <<deck
*HEADING
Scene A, elements of 0.1/$k
*BLOCK, TYPE=CPE4, ELSET=LOWER, NX=$((6*k)), NY=$((5*k))
0., 0.
.6, 0.
.6, .5
0., .5
*BLOCK, TYPE=CPE4, ELSET=OVER, NX=$((6*k)), NY=$((6*k))
0., .5
.6, .5
.6, 1.1
0., 1.1
*BLOCK, TYPE=CPE4, ELSET=SPAN, NX=$((26*k)), NY=$((6*k)), MERGE=OVER
.6, .5
3.2, .5
3.2, 1.1
.6, 1.1
*ELSET, ELSET=PLATE
OVER, SPAN
*MATERIAL, NAME=STONE
*ELASTIC
1000., .3
*SOLID SECTION, ELSET=LOWER, MATERIAL=STONE
1.
*SOLID SECTION, ELSET=PLATE, MATERIAL=STONE
1.
*SURFACE INTERACTION, NAME=JOINT
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR
1e7
*FRICTION, NONLOCAL
.3, 1e-7, .01
*CONTACT PAIR, INTERACTION=JOINT
OVER-BOTTOM, LOWER-TOP
*BOUNDARY
LOWER-BOTTOM, 1, 2
SPAN-RIGHT, 1
*STEP
*STATIC
*DSLOAD
OVER-TOP, P, 1.
SPAN-TOP, P, 1.
deck
if [ "$printed" = all ]; then
   printf '*NODE PRINT\nU, RF\n*EL PRINT\nS\n'
else
   printf '*NODE PRINT, NSET=OVER-BOTTOM\nU\n'
fi
printf '*CONTACT PRINT\n*END STEP\n'
