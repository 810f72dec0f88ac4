# A belt over a quarter of a rigid pulley, both ends guided across their faces: -v n=6 -v turn=0 -v digits=17 -v type=CPS4 -v free=1
function put(x) { return sprintf("%." digits "g", x) + 0 == 0 ? "0" : sprintf("%." digits "g", x) }
function at(r, a) { return put(r*cos(a + t)) ", " put(r*sin(a + t)) }
BEGIN {
   pi = 4*atan2(1, 1); t = turn*pi/180; q = (type ~ /9/) ? 2 : 1
   print "*HEADING\nA guided belt\n*NODE, NSET=ALL"
   for (j = 0; j <= q*n; j++) for (i = 0; i <= q; i++) print 1 + (q + 1)*j + i ", " at(0.55 + 0.05*i/q, pi/2*j/(q*n))
   print "*ELEMENT, TYPE=" type ", ELSET=BELT"
   for (j = 0; j < n; j++) { a = 1 + (q + 1)*q*j
      if (q == 1) print j + 1 ", " a ", " a + 1 ", " a + 3 ", " a + 2
      else print j + 1 ", " a ", " a + 2 ", " a + 8 ", " a + 6 ", " a + 1 ", " a + 5 ", " a + 7 ", " a + 3 ", " a + 4 }
   print "*SURFACE, NAME=INSIDE\nBELT, S4\n*SURFACE, NAME=PULL\n1, S1\n*NSET, NSET=FREE"
   for (i = 0; i <= q; i++) print 1 + i
   print "*NSET, NSET=HELD"
   for (i = 0; i <= q; i++) print 1 + (q + 1)*q*n + i
   print "*SURFACE, NAME=RIM, TYPE=SEGMENTS\nSTART, " at(0.55, pi/2 + 0.1) "\nCIRCL, " at(0.55, pi/4) ", 0, 0\nCIRCL, " at(0.55, -0.1) ", 0, 0"
   print "*RIGID BODY, ANALYTICAL SURFACE=RIM\n*MATERIAL, NAME=M\n*ELASTIC\n1e10, 0.3\n*SOLID SECTION, ELSET=BELT, MATERIAL=M\n0.2"
   print "*SURFACE INTERACTION, NAME=I\n*CONTACT PAIR, INTERACTION=I\nINSIDE, RIM"
   if (turn != 0) printf "*TRANSFORM, NSET=HELD\n%.17g, %.17g, 0, %.17g, %.17g, 0\n", cos(t), sin(t), -sin(t), cos(t)
   if (turn != 0 && free) printf "*TRANSFORM, NSET=FREE\n%.17g, %.17g, 0, %.17g, %.17g, 0\n", cos(t), sin(t), -sin(t), cos(t)
   print "*BOUNDARY\nHELD, 1"
   if (free) print "FREE, 1"
   print "*STEP\n*STATIC\n*DSLOAD\nPULL, P, -1e7\n*NODE PRINT\nU, RF\n*END STEP"
}
