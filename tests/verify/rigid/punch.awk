# A rigid flat punch of half width 1 on a half plane (4000 x 2000 of it): a deck on standard output.
#
#    awk -v n=16 -v step="*CLOAD/1000, 2, -1." -v friction="*FRICTION/0.3" -v angle=0 -v unit=1 -v force=1 -f punch.awk
#
# n: elements below either half of the punch, the last a twentieth of the first. step: lines of the step. The scene is turned by
# `angle` degrees; lengths are multiplied by `unit`, E by force/unit^2.
function point(x, y) {
   return sprintf("%.17g, %.17g", unit*(c*x - s*y), unit*(s*x + c*y))
}
function block(name, nx, x1, x2, grade, merge) {
   print "*BLOCK, TYPE=CPE9, ELSET=" name ", NX=" nx ", NY=" rows merge
   print point(x1, -2000); print point(x2, -2000); print point(x2, 0); print point(x1, 0); print "GRADE, " grade ", 0.00001"
}
BEGIN {
   if (n == "") n = 16
   if (unit == "") unit = 1
   if (force == "") force = 1
   rows = 30
   c = cos(angle*atan2(0, -1)/180); s = sin(angle*atan2(0, -1)/180)
   print "*HEADING\nrigid flat punch\n*NODE\n1000, " point(0, 0)
   block("RIGHT", n, 0, 1, 0.05, "")
   block("LEFT", n, -1, 0, 20, ", MERGE=RIGHT")
   block("FAR-RIGHT", 30, 1, 2000, 20000, ", MERGE=RIGHT")
   block("FAR-LEFT", 30, -2000, -1, 0.00005, ", MERGE=LEFT")
   print "*MATERIAL, NAME=SOFT\n*ELASTIC\n" sprintf("%.17g", force/unit^2) ", 0.3"
   for (i = split("RIGHT LEFT FAR-RIGHT FAR-LEFT", name, " "); i > 0; i--) print "*SOLID SECTION, ELSET=" name[i] ", MATERIAL=SOFT\n" unit
   print "*SURFACE, NAME=PUNCH, TYPE=SEGMENTS\nSTART, " point(1, 0) "\nLINE, " point(-1, 0)
   print "*RIGID BODY, ANALYTICAL SURFACE=PUNCH, REF NODE=1000"
   print "*SURFACE INTERACTION, NAME=JOINT"
   if (friction != "") { k = split(friction, line, "/"); for (i = 1; i <= k; i++) print line[i] }
   print "*CONTACT PAIR, INTERACTION=JOINT\nRIGHT-TOP, PUNCH\nLEFT-TOP, PUNCH"
   print "*BOUNDARY\nRIGHT-BOTTOM, 1, 2\nLEFT-BOTTOM, 1, 2\nFAR-RIGHT-BOTTOM, 1, 2\nFAR-LEFT-BOTTOM, 1, 2"
   print "*STEP\n*STATIC"
   k = split(step, line, "/"); for (i = 1; i <= k; i++) print line[i]
   print "*CONTACT PRINT\n*NODE PRINT, NSET=RIGHT-TOP\nU\n*END STEP"
}
