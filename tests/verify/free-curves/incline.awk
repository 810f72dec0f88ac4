# A block pressed onto an inclined line without friction, by 2 on its side: -v digits=6 -v angle=30 -v n=4 -v element=CPE8 -v push=0.
function place(x, y,   a, b) { a = sprintf("%." digits "g", c*x - s*y) + 0; b = sprintf("%." digits "g", s*x + c*y) + 0; return sprintf("%.17g, %.17g", a, b) }
BEGIN {
   t = angle*atan2(1, 1)/45; c = cos(t); s = sin(t)
   print "*HEADING\nA block on an incline\n*BLOCK, ELSET=B, TYPE=" element ", NX=" n ", NY=" n
   print place(0.3, 0); print place(1.7, 0); print place(1.7, 1.1); print place(0.3, 1.1)
   print "*MATERIAL, NAME=M\n*ELASTIC\n1000, 0.3\n*SOLID SECTION, ELSET=B, MATERIAL=M\n1"
   print "*SURFACE, NAME=G, TYPE=SEGMENTS\nSTART, " place(-3, 0) "\nLINE, " place(4, 0) "\n*RIGID BODY, ANALYTICAL SURFACE=G"
   print "*SURFACE INTERACTION, NAME=I\n*CONTACT PAIR, INTERACTION=I\nB-BOTTOM, G\n*STEP\n*STATIC\n*DSLOAD\nB-TOP, P, 2"
   if (push) print "B-LEFT, P, " push
   print "*END STEP"
}
