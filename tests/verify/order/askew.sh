#!/bin/sh
# Prints the deck of a long block that lies askew.
cat <<END
*PARAMETER
c = .8660254037844387
s = .5
left = -s
middle = c - s
above = c + s
*BLOCK, TYPE=CPE4, ELSET=ALL, NX=20, NY=500
0., 0.
<c>, <s>
<middle>, <above>
<left>, <c>
*MATERIAL, NAME=STONE
*ELASTIC
1000., .3
*SOLID SECTION, ELSET=ALL, MATERIAL=STONE
1.
*BOUNDARY
ALL-BOTTOM, 1, 2
*STEP
*STATIC
*DLOAD
ALL, BX, 1.
*NODE PRINT
U
*END STEP
END
