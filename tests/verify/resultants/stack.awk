# Two blocks of 2 x 1, one on the other on a rigid floor, turned about the origin by `a` degrees; with roles=1 the lower block is the
# slave. Weight 2 each, a pressure on the left side of the upper one that comes to 0.5, a force of 0.8 at its upper left corner, down.
# Lengths in units of 1/L, forces of 1/F: awk -v a=0 -v roles=0 -v L=1 -v F=1 -f stack.awk
function place(x, y) { printf "%.17g, %.17g\n", L*(c*x - s*y), L*(s*x + c*y) }
function block(name, y) {
   printf "*BLOCK, TYPE=CPE4, ELSET=%s, NX=4, NY=2\n", name
   place(0, y); place(2, y); place(2, y + 1); place(0, y + 1)
   printf "*SOLID SECTION, ELSET=%s, MATERIAL=STONE\n%.17g\n", name, L
}
BEGIN {
   pi = atan2(0, -1); s = sin(a*pi/180); c = cos(a*pi/180)
   block("LOWER", 0); block("UPPER", 1)
   printf "*MATERIAL, NAME=STONE\n*ELASTIC\n%.17g, 0.2\n", 1e4*F/L^2
   print "*SURFACE, NAME=FLOOR, TYPE=SEGMENTS"
   printf "START, "; place(-1, 0); printf "LINE, "; place(3, 0)
   print "*RIGID BODY, ANALYTICAL SURFACE=FLOOR\n*SURFACE INTERACTION, NAME=JOINT\n*FRICTION\n0.5\n*CONTACT PAIR, INTERACTION=JOINT"
   print (roles ? "LOWER-TOP, UPPER-BOTTOM" : "UPPER-BOTTOM, LOWER-TOP")
   print "LOWER-BOTTOM, FLOOR\n*STEP\n*STATIC\n*DLOAD"
   printf "LOWER, BX, %.17g\nLOWER, BY, %.17g\nUPPER, BX, %.17g\nUPPER, BY, %.17g\n", s*F/L^3, -c*F/L^3, s*F/L^3, -c*F/L^3
   printf "*DSLOAD\nUPPER-LEFT, P, %.17g\n*CLOAD\n26, 1, %.17g\n26, 2, %.17g\n", 0.5*F/L^2, 0.8*s*F, -0.8*c*F
   print "*CONTROLS, TOLERANCE=1e-12\n*BODY PRINT\n*JOINT PRINT\n*NODE PRINT\nU\n*END STEP"
}
