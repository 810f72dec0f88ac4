# Two rigid plates with reference nodes 1001, 1002, each on a block of its own: a deck on standard output.
#
#    awk -v joint="*SPRING, ..." -v held="*BOUNDARY/..." -v step="*CLOAD/1001, 2, -1." -v angle=0 -v type=CPE4 -f plate.awk
#
# joint, held, step: lines of the model, of the supports before *STEP, and of the steps, with / between them. The scene is turned by
# `angle` degrees. Nodes 2001 and 2002 are in no element.
function point(x, y) {
   return sprintf("%.17g, %.17g", c*x - s*y, s*x + c*y)
}
function lines(text,   k, i, line) {
   if (text == "") return
   k = split(text, line, "/"); for (i = 1; i <= k; i++) print line[i]
}
function block(name, x) {
   print "*BLOCK, TYPE=" type ", ELSET=" name ", NX=8, NY=3"
   print point(x - 1, -1); print point(x + 1, -1); print point(x + 1, 0); print point(x - 1, 0)
}
function plate(name, x) {
   print "*SURFACE, NAME=" name ", TYPE=SEGMENTS\nSTART, " point(x + 1.5, 0) "\nLINE, " point(x - 1.5, 0)
   print "*RIGID BODY, ANALYTICAL SURFACE=" name ", REF NODE=100" (name == "P1" ? 1 : 2)
}
BEGIN {
   if (type == "") type = "CPE4"
   if (friction == "") friction = 0.3
   c = cos(angle*atan2(0, -1)/180); s = sin(angle*atan2(0, -1)/180)
   print "*HEADING\nrigid plates, joined\n*NODE\n1001, " point(0, 0.5) "\n1002, " point(5, 0.5) "\n2001, " point(0, 3) "\n2002, " point(5, 3)
   print "*NSET, NSET=REFS\n1001, 1002"
   block("A", 0); block("B", 5)
   print "*MATERIAL, NAME=SOFT\n*ELASTIC\n1000., 0.3\n*SOLID SECTION, ELSET=A, MATERIAL=SOFT\n*SOLID SECTION, ELSET=B, MATERIAL=SOFT"
   plate("P1", 0); plate("P2", 5)
   print "*SURFACE INTERACTION, NAME=I\n*FRICTION\n" friction "\n*CONTACT PAIR, INTERACTION=I\nA-TOP, P1\nB-TOP, P2"
   lines(joint)
   print "*BOUNDARY\nA-BOTTOM, 1, 2\nB-BOTTOM, 1, 2"
   lines(held)
   k = split(step, parts, "//")
   for (i = 1; i <= k; i++) { print "*STEP\n*STATIC"; lines(parts[i]); print "*NODE PRINT\nU, RF\n*END STEP" }
}
