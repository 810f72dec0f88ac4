# A roller of 24 straight faces, a node of which stands on a straight rigid line: -v digits=6 -v angle=30 -v off=0 -v nu=0. The frame is
# turned by the angle; the roller is pushed onto the line by 2 at the two nodes of its bore that lie above each other, off by a part of the
# radius.
function put(x) { return sprintf("%." digits "g", x) + 0 == 0 ? "0" : sprintf("%." digits "g", x) }
function place(x, y) { return put(cos(turn)*x - sin(turn)*y + 7.3) ", " put(sin(turn)*x + cos(turn)*y - 2.9) }
BEGIN {
   pi = 4*atan2(1, 1); turn = angle*pi/180; faces = 24
   print "*HEADING\nA roller on one node\n*NODE"
   for (j = 0; j < faces; j++) for (i = 0; i <= 2; i++) {
      a = 2*pi*j/faces - pi/2; r = 0.4 + 0.3*i
      print 1 + 3*j + i ", " place(r*cos(a), 1 + r*sin(a)) }
   print "*ELEMENT, TYPE=CPE4, ELSET=ROLLER"
   for (j = 0; j < faces; j++) for (i = 0; i < 2; i++) {
      k = (j + 1)%faces
      print ++n ", " 1 + 3*j + i ", " 2 + 3*j + i ", " 2 + 3*k + i ", " 1 + 3*k + i }
   print "*SURFACE, NAME=RIM"
   for (j = 0; j < faces; j++) if (j < 5 || j >= faces - 5) print 2*j + 2 ", S2"
   print "*SURFACE, NAME=FLAT, TYPE=SEGMENTS\nSTART, " place(-1.5, 0) "\nLINE, " place(1.5, 0) "\n*RIGID BODY, ANALYTICAL SURFACE=FLAT"
   print "*MATERIAL, NAME=M\n*ELASTIC\n1e4, 0.3\n*SOLID SECTION, ELSET=ROLLER, MATERIAL=M"
   print "*SURFACE INTERACTION, NAME=I" (nu > 0 ? "\n*FRICTION\n" nu : "") "\n*CONTACT PAIR, INTERACTION=I\nRIM, FLAT\n*STEP\n*STATIC\n*CLOAD"
   for (k = 0; k < 2; k++) {
      node = 1 + 3*(12*k)
      printf "%d, 1, %.17g\n%d, 2, %.17g\n", node, sin(turn), node, -cos(turn) }
   # a couple that puts the load beside the node
   if (off != 0) {
      printf "1, 1, %.17g\n1, 2, %.17g\n", -2*off/0.8*cos(turn), -2*off/0.8*sin(turn)
      printf "37, 1, %.17g\n37, 2, %.17g\n", 2*off/0.8*cos(turn), 2*off/0.8*sin(turn) }
   print "*NODE PRINT\nU\n*END STEP"
}
