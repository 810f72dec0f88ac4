# A ring of 24 straight faces, and a drawn line: -v digits=6 -v angle=30 -v moment=0 -v slot=0. The drawn line is a round pin in the ring, which
# is held outside; the pin moves with a reference node beside its centre and is pushed by 1 through the centre. With slot=1 it is a slot of two
# straight sides with round ends, in one of which the ring lies; that is pushed into the end by 1 at the nodes of its hole.
function put(x) { return sprintf("%." digits "g", x) + 0 == 0 ? "0" : sprintf("%." digits "g", x) }
function place(x, y) { return put(c*x - s*y + 0.3) ", " put(s*x + c*y - 0.2) }
function arc(a) { print "CIRCL, " place(x0 + cos(a), sin(a)) ", " place(x0, 0) }
function load(node, fx, fy) { printf "%d, 1, %.17g\n%d, 2, %.17g\n", node, c*fx - s*fy, node, s*fx + c*fy }
BEGIN {
   pi = 4*atan2(1, 1); c = cos(angle*pi/180); s = sin(angle*pi/180); n = 24; r1 = slot ? 0.3 : 1; r2 = slot ? 1 : 2
   print "*HEADING\nA drawn line and a ring\n*NODE"
   for (j = 0; j < n; j++) for (i = 0; i <= 2; i++) { r = r1 + (r2 - r1)*i/2; print 1 + 3*j + i ", " place(r*cos(2*pi*j/n), r*sin(2*pi*j/n)) }
   if (!slot) print "1000, " place(0.7, 1/3)
   print "*ELEMENT, TYPE=CPE4, ELSET=RING"
   for (j = 0; j < n; j++) for (i = 0; i < 2; i++) { k = (j + 1)%n; print ++e ", " 1 + 3*j + i ", " 2 + 3*j + i ", " 2 + 3*k + i ", " 1 + 3*k + i }
   print "*SURFACE, NAME=SIDE"
   for (j = 0; j < n; j++) print slot ? 2*j + 2 ", S2" : 2*j + 1 ", S4"
   for (i = 0; i <= 2; i += 2) { print "*NSET, NSET=" (i ? "OUTSIDE" : "BORE"); for (j = 0; j < n; j++) print 1 + 3*j + i }
   print "*SURFACE, NAME=LINE, TYPE=SEGMENTS"
   if (slot) {
      print "START, " place(-4, -1) "\nLINE, " place(0, -1)
      arc(0); arc(pi/2); print "LINE, " place(-4, 1); x0 = -4; arc(pi); arc(-pi/2)
      print "*RIGID BODY, ANALYTICAL SURFACE=LINE"
   } else {
      print "START, " place(1, 0); for (k = 1; k <= 4; k++) arc(-k*pi/2)
      print "*RIGID BODY, ANALYTICAL SURFACE=LINE, REF NODE=1000\n*BOUNDARY\nOUTSIDE, 1, 2" }
   print "*MATERIAL, NAME=M\n*ELASTIC\n1e3, 0.3\n*SOLID SECTION, ELSET=RING, MATERIAL=M"
   print "*SURFACE INTERACTION, NAME=I\n*CONTACT PAIR, INTERACTION=I\nSIDE, LINE\n*STEP\n*STATIC\n*CLOAD"
   if (slot) for (j = 0; j < n; j++) {
      a = 2*pi*j/n; load(1 + 3*j, 1/n - moment/n/0.3*sin(a), moment/n/0.3*cos(a))
   } else { load(1000, 0, -1); printf "1000, 6, %.17g\n", 0.7 + moment }
   print "*NODE PRINT\nU, RF\n*END STEP"
}
