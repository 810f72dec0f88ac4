# An L of three squares of side 1, one end pulled, rollers on two others: the re-entrant corner is the only singularity.
#    awk -v order=1|2 -f corner.awk </dev/null     prints the deck, to be refined
BEGIN {
   type = "CPE" (order == 1 ? 4 : 9)
   print "*HEADING\nRe-entrant corner"
   print "*BLOCK, TYPE=" type ", ELSET=A, NX=2, NY=2\n-1, 0\n0, 0\n0, 1\n-1, 1"
   print "*BLOCK, TYPE=" type ", ELSET=B, NX=2, NY=2, MERGE=A\n0, 0\n1, 0\n1, 1\n0, 1"
   print "*BLOCK, TYPE=" type ", ELSET=C, NX=2, NY=2, MERGE=A\n-1, -1\n0, -1\n0, 0\n-1, 0"
   print "*ELSET, ELSET=ALL\nA, B, C\n*MATERIAL, NAME=M\n*ELASTIC\n1, 0.3\n*SOLID SECTION, ELSET=ALL, MATERIAL=M"
   print "*BOUNDARY\nA-LEFT, 1\nC-LEFT, 1\nC-BOTTOM, 2\n*STEP\n*STATIC\n*DSLOAD\nB-RIGHT, P, -1\n*END STEP"
}
