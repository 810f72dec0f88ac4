# Two blocks, one tied on the other, turned by an angle about the origin: awk -v na= -v nb= [-v angle= -v type= -v exchange=1
# -v gap= -v options= -v layer=1 -v length= -v unit= -v force=]. layer: the tie joins the layers of a cantilever.
function place(x, y) { return sprintf("%.17g, %.17g", unit*(c*x - s*y), unit*(s*x + c*y)) }
function block(name, n, y0, y1) {
   printf "*BLOCK, TYPE=%s, ELSET=%s, NX=%d, NY=%d\n", type, name, n, ny
   print place(0, y0); print place(len, y0); print place(len, y1); print place(0, y1)
}
BEGIN {
   if (type == "") type = "CPS4"; if (length_ > 0) len = length_; else len = 3
   if (unit == "") unit = 1; if (force == "") force = 1; if (ny == "") ny = 3
   c = cos(angle*atan2(0, -1)/180); s = sin(angle*atan2(0, -1)/180)
   print "*HEADING\nTwo blocks that are tied"
   block("A", na, 0, 1); block("B", nb, 1 + gap, 2)
   print "*ELSET, ELSET=ALL\nA, B\n*MATERIAL, NAME=M\n*ELASTIC"
   printf "%.17g, 0.3\n*SOLID SECTION, ELSET=ALL, MATERIAL=M\n%.17g\n", 1000*force/unit^2, unit
   print "*TIE, NAME=GLUE" options
   print exchange ? "A-TOP, B-BOTTOM" : "B-BOTTOM, A-TOP"
   if (layer) print "*BOUNDARY\nA-LEFT, 1, 2"
   else {
      printf "*TRANSFORM, NSET=A\n%.17g, %.17g, 0., %.17g, %.17g, 0.\n", c, s, -s, c
      print "*BOUNDARY\nA-BOTTOM, 2\n1, 1"
   }
   print "*STEP\n*STATIC\n*DSLOAD"
   printf "B-TOP, P, %.17g\n", (layer ? 0.01 : 10)*force/unit^2
   print "*NODE PRINT\nU, RF\n*EL PRINT\nS\n*BODY PRINT\n*END STEP"
}
