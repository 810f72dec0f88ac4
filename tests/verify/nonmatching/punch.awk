# Half of a stiff flat punch of half width 1 on a half plane (2000 x 2000 of it): a deck on standard output.
#
#    awk -v above=20 -v below=28 -v friction="*FRICTION, NONLOCAL/0.3, 0, 0" -v type=CPE9 -v roles=0 -f punch.awk
#
# above, below: elements of either side under the punch, the last a twentieth of the first. roles = 1: the half plane is the slave.
function block(name, n, m, x1, y1, x2, y2, grade, merge) {
   print "*BLOCK, TYPE=" type ", ELSET=" name ", NX=" n ", NY=" m merge
   print x1 ", " y1; print x2 ", " y1; print x2 ", " y2; print x1 ", " y2; print "GRADE, " grade
}
BEGIN {
   if (nu == "") nu = 0.3
   print "*HEADING\nflat punch\n*PARAMETER\nnu = " nu
   block("NEAR", below, 40, 0, -2000, 1, 0, "0.05, 0.00001", "")
   block("FAR", 40, 40, 1, -2000, 2000, 0, "20000, 0.00001", ", MERGE=NEAR")
   block("PUNCH", above, 12, 0, 0, 1, 1, "0.05, 10", "")
   print "*MATERIAL, NAME=SOFT\n*ELASTIC\n1., <nu>\n*MATERIAL, NAME=STIFF\n*ELASTIC\n1e7, 0.3"
   print "*SOLID SECTION, ELSET=NEAR, MATERIAL=SOFT\n*SOLID SECTION, ELSET=FAR, MATERIAL=SOFT\n*SOLID SECTION, ELSET=PUNCH, MATERIAL=STIFF"
   print "*SURFACE INTERACTION, NAME=JOINT"
   if (friction != "") { n = split(friction, line, "/"); for (i = 1; i <= n; i++) print line[i] }
   print "*CONTACT PAIR, INTERACTION=JOINT\n" (roles ? "NEAR-TOP, PUNCH-BOTTOM" : "PUNCH-BOTTOM, NEAR-TOP")
   print "*BOUNDARY\nNEAR-LEFT, 1\nPUNCH-LEFT, 1\nNEAR-BOTTOM, 1, 2\nFAR-BOTTOM, 1, 2"
   print "*STEP\n*STATIC\n*DSLOAD\nPUNCH-TOP, P, 0.5\n*CONTACT PRINT\n*END STEP"
}
