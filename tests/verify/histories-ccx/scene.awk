# Two rectangles of E = 1000, mu = 0.3 with friction, one on the other, as a deck that both atrito and CalculiX read; the steps follow from
# standard input.
#
#    awk -v type=CPE4 -v above=20 -v below=40 [-v radius=8] [-v gap=0.001] [-v nu=0.3] [-v K=1e6] [-v stick=1e5]
#        [-v thick=0.01] [-v shift=2] -f scene.awk <steps.inp
#
# The lower one is 2 x 1 around x = 0 with its base held, `below` elements along its top; the upper one 1 x 0.5 with `above` elements, its
# under side a circle of `radius` or straight, `gap` above the lower one; both are `shift` to the right of x = 0. Sets TOP and BASE of nodes, and TOP-ROW
# of elements, whose faces 3 are the top.
function body(name, nx, ny, x0, width, y0, height, r, faces, far,    i, j, x, y, q, c, order, s, t) {
   order = type ~ /8/ ? 2 : 1
   print "*NODE, NSET=" name "-NODES"
   for (j = 0; j <= order*ny; j++) for (i = 0; i <= order*nx; i++) if (order == 1 || i%2 == 0 || j%2 == 0) {
      x = shift + x0 + width*i/(order*nx)
      t = graded(j, order, ny, name == "LOWER")
      y = y0 + height*t
      if (r > 0) y += (1 - t)*(x - shift)^2/(r + sqrt(r*r - (x - shift)^2))
      printf "%d, %.12g, %.12g\n", nodes + j*(order*nx + 1) + i + 1, x, y
   }
   print "*ELEMENT, TYPE=" type ", ELSET=" name
   for (j = 0; j < ny; j++) for (i = 0; i < nx; i++) {
      c = nodes + order*j*(order*nx + 1) + order*i + 1
      q = order*nx + 1
      printf "%d, %d, %d, %d, %d", ++cells, c, c + order, c + order + order*q, c + order*q
      if (order == 2) printf ", %d, %d, %d, %d", c + 1, c + 2 + q, c + 1 + 2*q, c + q
      printf "\n"
      if (j == 0) first = first cells ", S1\n"
      if (j == ny - 1) { last = last cells ", S3\n"; row = row cells "\n" }
   }
   if (name == "LOWER") print "*SURFACE, NAME=LOWER-FACE, TYPE=ELEMENT\n" last "*NSET, NSET=BASE"
   else print "*SURFACE, NAME=UPPER-FACE, TYPE=ELEMENT\n" first "*ELSET, ELSET=TOP-ROW\n" row "*NSET, NSET=TOP"
   for (i = 0; i <= order*nx; i++) print nodes + (name == "LOWER" ? 0 : order*ny*(order*nx + 1)) + i + 1
   nodes += (order*nx + 1)*(order*ny + 1)
   first = last = row = ""
}
# Rows become finer towards the contact; the middles of elements stay in the middle.
function graded(j, order, ny, up,    t) {
   if (order == 2 && j%2) return (graded(j - 1, order, ny, up) + graded(j + 1, order, ny, up))/2
   t = j/(order*ny)
   return up ? 1 - (1 - t)^1.5 : t^1.5
}
BEGIN {
   if (nu == "") nu = 0.3
   if (thick == "") thick = "1."
   if (K == "") K = 1e6
   if (stick == "") stick = 1e5
   print "*HEADING\ntwo bodies, pressed and pushed"
   body("LOWER", below, int(below/2), -1, 2, -1, 1, 0)
   body("UPPER", above, int(above/2), -0.5, 1, gap + 0, 0.5, radius + 0)
   print "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3"
   print "*SOLID SECTION, ELSET=LOWER, MATERIAL=M\n" thick "\n*SOLID SECTION, ELSET=UPPER, MATERIAL=M\n" thick
   printf "*SURFACE INTERACTION, NAME=ROUGH\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n%g\n*FRICTION\n%g, %g\n", K, nu, stick
   print "*CONTACT PAIR, INTERACTION=ROUGH, TYPE=SURFACE TO SURFACE\nUPPER-FACE, LOWER-FACE"
   print "*BOUNDARY\nBASE, 1, 2"
   while ((getline line) > 0) print line
}
