# A rigid cylinder of radius 10 on a block 3 deep from x0 (0 or -3) to 3: a deck on standard output.
#
#    awk -v type=CPE8 -v x0=-3 -v nu=0.3 -v step="*CLOAD/1000, 2, -5." -f roll.awk
#
# step: lines of the step. nu = 0: no friction.
BEGIN {
   print "*HEADING\nrigid cylinder\n*NODE\n1000, 0, 10"
   print "*BLOCK, TYPE=" type ", ELSET=LOW, NX=" (x0 < 0 ? 40 : 20) ", NY=12\n" x0 ", -3.\n3., -3.\n3., 0.\n" x0 ", 0."
   print "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*SOLID SECTION, ELSET=LOW, MATERIAL=M"
   print "*SURFACE, NAME=ROLL, TYPE=SEGMENTS\nSTART, 6, 2\nCIRCL, 0, 0, 0, 10\nCIRCL, -6, 2, 0, 10"
   print "*RIGID BODY, ANALYTICAL SURFACE=ROLL, REF NODE=1000"
   print "*SURFACE INTERACTION, NAME=JOINT"
   if (nu > 0) print "*FRICTION\n" nu
   print "*CONTACT PAIR, INTERACTION=JOINT\nLOW-TOP, ROLL\n*BOUNDARY\nLOW-BOTTOM, 1, 2"
   if (x0 == 0) print "LOW-LEFT, 1"
   print "*STEP\n*STATIC"
   k = split(step, line, "/"); for (i = 1; i <= k; i++) print line[i]
   print "*CONTACT PRINT\n*NODE PRINT\nU\n*END STEP"
}
