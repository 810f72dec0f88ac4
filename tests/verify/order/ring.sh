#!/bin/sh
# Prints the deck of a ring of flat elements, clamped inside and pulled to one side: they lie in no direction in particular.
#    ring.sh N       N elements along the circle, 8 from the inner to the outer one
here=$(dirname "$0")
awk -v type=CPE4 -v n=8 -v m="$1" -v map=ring -v r1=1 -v r2=2 -v turn=360 -f "$here/../mesh.awk"
cat <<deck
*MATERIAL, NAME=STONE
*ELASTIC
1000., .3
*SOLID SECTION, ELSET=ALL, MATERIAL=STONE
1.
*BOUNDARY
ALL-LEFT, 1, 2
*STEP
*STATIC
*DLOAD
ALL, BX, 1.
*NODE PRINT
U
*END STEP
deck
