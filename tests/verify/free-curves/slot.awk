# A block of 3 x 1 that is pressed into a slot between two straight rigid lines, which overlap it by 0.05 each, and pushed along them at all of
# its nodes: -v digits=6 -v angle=30 -v force=50 -v nu=0.1 -v quadrature=NODAL. mu = 0 and E = 1000, so each line presses with 300 times the
# thickness of one, and friction holds up to 2 nu 300.
function put(x) { return sprintf("%." digits "g", x) + 0 == 0 ? "0" : sprintf("%." digits "g", x) }
function place(x, y) { return put(cos(turn)*x - sin(turn)*y + 1.3) ", " put(sin(turn)*x + cos(turn)*y - 2.9) }
function line(name, y, from, to) {
   print "*SURFACE, NAME=" name ", TYPE=SEGMENTS\nSTART, " place(from, y) "\nLINE, " place(to, y) "\n*RIGID BODY, ANALYTICAL SURFACE=" name
}
BEGIN {
   turn = angle*atan2(1, 1)/45
   print "*HEADING\nA block in a slot\n*NODE, NSET=ALL"
   for (j = 0; j <= 2; j++) for (i = 0; i <= 6; i++) print 10*j + i + 1 ", " place(i/2, j/2)
   print "*ELEMENT, TYPE=CPE4, ELSET=BLOCK"
   for (j = 0; j < 2; j++) for (i = 0; i < 6; i++) {
      k = 10*j + i + 1
      print k ", " k ", " k + 1 ", " k + 11 ", " k + 10 }
   print "*SURFACE, NAME=LOW"
   for (i = 1; i <= 6; i++) print i ", S1"
   print "*SURFACE, NAME=HIGH"
   for (i = 1; i <= 6; i++) print 10 + i ", S3"
   line("FLOOR", 0.05, -1, 4)
   line("ROOF", 0.95, 5, -2)
   print "*MATERIAL, NAME=M\n*ELASTIC\n1000, 0\n*SOLID SECTION, ELSET=BLOCK, MATERIAL=M\n*SURFACE INTERACTION, NAME=I\n*FRICTION\n" nu
   print "*CONTACT PAIR, INTERACTION=I\nLOW, FLOOR\n*CONTACT PAIR, INTERACTION=I\nHIGH, ROOF\n*STEP\n*STATIC\n*CLOAD"
   printf "ALL, 1, %.17g\nALL, 2, %.17g\n", force/21*cos(turn), force/21*sin(turn)
   print "*NODE PRINT\nU\n*END STEP"
}
