# Two elastic bodies of 10 x 10 that touch at the origin, the right half of them: a deck on standard output.
#
#    awk -v type=CPE4 -v n=32 -v m=32 -v radius=0 -v slave=A -v load=3.9 -f bodies.awk
#
# A stands above, its lower side a circle of radius 10 up to x = 3, then straight; B lies below, its upper side straight (radius 0),
# a circle of that radius, or hollow (radius < 0). rigid=A or rigid=B: that one is a rigid line. n and m elements to x = 1, growing by 1.15 beyond. load: on the whole width [F/L];
# of axisymmetric elements, pressure on A times 20.
function side(x, r,    s, q) {
   if (r == 0) return 0
   s = r > 0 ? 1 : -1
   q = x < 3 ? x : 3
   return s*(q*q/(s*r + sqrt(r*r - q*q)) + (x - q)*q/sqrt(r*r - q*q))
}
# Places 0, h, .. up to `fine`, then growing up to 10, with the middles for nine nodes: line[1..count].
function make_line(line, elements, fine,    h, k, x, count) {
   h = fine/elements
   k = 1
   x[1] = 0
   while (x[k] < 10 - 1e-12) {
      if (k > elements) h *= 1.15
      k++
      x[k] = k - 1 <= elements ? (k - 1)*h : x[k - 1] + h
      if (x[k] > 10 - h/2) x[k] = 10
   }
   count = 0
   for (h = 1; h <= k; h++) {
      if (h > 1 && middle) line[++count] = (x[h - 1] + x[h])/2
      line[++count] = x[h]
   }
   return count
}
function make_body(name, r, sign, elements,    nx, ny, i, j, q, c, b, a, surface, far) {
   nx = make_line(along, elements, 1)
   ny = make_line(up, elements/2, 0.5)
   print "*NODE"
   for (j = 1; j <= ny; j++) for (i = 1; i <= nx; i++)
      if (!hollow || i%2 || j%2) printf "%d, %.17g, %.17g\n", nodes + (j - 1)*nx + i, along[i], sign*((1 - up[j]/10)*side(along[i], r) + up[j])
   print "*ELEMENT, TYPE=" type ", ELSET=" name
   q = middle ? 2 : 1
   for (j = 1; j < ny; j += q) for (i = 1; i < nx; i += q) {
      c = nodes + (j - 1)*nx + i                   # lower left
      b = sign > 0 ? c : c + q*nx                  # the side that comes first, counter-clockwise in the plane
      a = sign > 0 ? c + q*nx : c
      if (triangles) {
         # cut from b + q to a
         printf "%d, %d, %d, %d", ++cells, b, b + q, a
         if (middle) printf ", %d, %d, %d", b + 1, c + nx + 1, c + nx
         if (j == 1 && sign > 0) surface = surface cells ", S1\n"
         if (j + q == ny && sign < 0) far = far cells ", S1\n"
         printf "\n%d, %d, %d, %d", ++cells, b + q, a + q, a
         if (middle) printf ", %d, %d, %d", c + nx + 2, a + 1, c + nx + 1
         if (j == 1 && sign < 0) surface = surface cells ", S2\n"
         if (j + q == ny && sign > 0) far = far cells ", S2\n"
         printf "\n"
         continue
      }
      printf "%d, %d, %d, %d, %d", ++cells, b, b + q, a + q, a
      if (middle) printf ", %d, %d, %d, %d", b + 1, c + nx + 2, a + 1, c + nx
      if (middle && !hollow) printf ", %d", c + nx + 1
      printf "\n"
      if (j == 1) surface = surface cells ", " (sign > 0 ? "S1" : "S3") "\n"
      if (j + q == ny) far = far cells ", " (sign > 0 ? "S3" : "S1") "\n"
   }
   printf "*SURFACE, NAME=%s-FACE\n%s*SURFACE, NAME=%s-FAR\n%s*NSET, NSET=%s-AXIS\n", name, surface, name, far, name
   for (j = 1; j <= ny; j++) print nodes + (j - 1)*nx + 1
   print "*NSET, NSET=" name "-BASE"
   for (i = 1; i <= nx; i++) print nodes + (ny - 1)*nx + i
   print "*SOLID SECTION, ELSET=" name ", MATERIAL=M"
   nodes += nx*ny
}
BEGIN {
   middle = type ~ /[689]/
   hollow = type ~ /8/
   triangles = type ~ /[36]/
   print "*HEADING\ntwo bodies that touch in a point"
   if (rigid != "A") make_body("A", 10, 1, n)
   if (rigid != "B") make_body("B", radius, -1, m)
   if (rigid == "B") print "*SURFACE, NAME=B-FACE, TYPE=SEGMENTS\nSTART, -1, 0\nLINE, 11, 0\n*RIGID BODY, ANALYTICAL SURFACE=B-FACE"
   if (rigid == "A") print "*SURFACE, NAME=A-FACE, TYPE=SEGMENTS\nSTART, 5, 1.3397459621556135\nCIRCL, 0, 0, 0, 10\n*RIGID BODY, ANALYTICAL SURFACE=A-FACE"
   print "*MATERIAL, NAME=M\n*ELASTIC\n1000, 0.3\n*SURFACE INTERACTION, NAME=I\n*CONTACT PAIR, INTERACTION=I" quadrature
   print slave == "A" ? "A-FACE, B-FACE" : "B-FACE, A-FACE"
   print "*STEP\n*STATIC\n*BOUNDARY"
   if (rigid != "A") print "A-AXIS, 1, 1"
   if (rigid != "B") print "B-AXIS, 1, 1"
   if (rigid == "") print "B-BASE, 2, 2"
   print "*DSLOAD"
   printf "%s-FAR, P, %.17g\n*CONTACT PRINT\n*END STEP\n", rigid == "A" ? "B" : "A", load/20
}
