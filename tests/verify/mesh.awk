# Writes a mesh of n by m quadrilaterals, or as many pairs of triangles, in the unit square, mapped: *NODE, *ELEMENT, *NSET OUTLINE (all outer nodes) and the
# sets and surfaces BOTTOM, RIGHT, TOP, LEFT, with the name of the element set in front.
#    awk -v type=CPE9 -v n=4 -v m=4 -v map=square [-v elset=ALL] [-v first=0] [-v dy=0] [-v r1=1 -v r2=2 -v turn=90] -f mesh.awk
# map: square      the unit square itself
#      trapezoids  inner lines zigzag by 0.3 of a row: trapezoids of the same shape at every n (n and m even)
#      ring        x along the radius from r1 to r2, y along the angle from `start` (default 0) over `turn` degrees
#                  (turn=360: closed; LEFT and RIGHT are the inner and the outer circle)
#      arched      four sides of parabolas, as a single element of the second degree has them
#      hill        the upper side is one parabola, 0.2 high in the middle; valley: the lower side (of what lies on the hill)
# first: numbers of nodes and elements begin above it. size, dy: all is multiplied by size, and dy added to y.
# gx, gy: elements become smaller towards the left or lower side by this power, towards the other one if negative. Curved Q2 sides: mid-side nodes lie on the mapped curve; trapezoids have
# theirs in the middle.
function corner(i, j) {
   px = i/n; py = j/m
   if (map == "trapezoids" && j > 0 && j < m) py += ((i + j) % 2 ? 0.3 : -0.3)/m*(j % 2)
}
# Power g of a place 0..1 towards 0, or towards 1 for g < 0; in the middle of an element the mean of its ends.
function graded(k, of, g,   z) {
   if (order == 2 && k % 2) return (graded(k - 1, of, g) + graded(k + 1, of, g))/2
   z = k/(order*of)
   return (g > 0) ? z^g : 1 - (1 - z)^(-g)
}
# The node at (i, j) counted in half elements for Q2.
function node(i, j,   a, b, x, y, r, t) {
   if (map == "trapezoids" && triangles && i % 2 && j % 2 && order == 2) {
      corner((i - 1)/2, (j - 1)/2); x = px/2; y = py/2; corner((i + 1)/2, (j + 1)/2); x += px/2; y += py/2
   } else if (map == "trapezoids" && order == 2) {
      x = 0; y = 0
      for (a = 0; a <= 1; a++) for (b = 0; b <= 1; b++) {
         corner(int((i + a)/2), int((j + b)/2)); x += px/4; y += py/4
      }
   } else if (map == "trapezoids") {
      corner(i, j); x = px; y = py
   } else {
      x = graded(i, n, gx); y = graded(j, m, gy)
   }
   if (map == "ring") {
      r = r1 + (r2 - r1)*x; t = (start + turn*y)*atan2(0, -1)/180
      x = r*cos(t); y = r*sin(t)
      if (x*x < 1e-30*r*r) x = 0
      if (y*y < 1e-30*r*r) y = 0
   }
   if (map == "arched") {
      r = x; t = y
      x = r + 0.15*4*t*(1 - t)*(1 - 2*r) + 0.1*r*t
      y = t + 0.12*4*r*(1 - r)*(1 + 0.5*t)
   }
   if (map == "hill") y += 0.8*x*(1 - x)*y
   if (map == "valley") y += 0.8*x*(1 - x)*(1 - y)
   px = size*x; py = size*y + dy
}
function id(i, j) { if (closed) j %= order*m; return first + j*(order*n + 1) + i + 1 }
BEGIN {
   if (elset == "") elset = "ALL"
   if (!gx) gx = 1
   if (!gy) gy = 1
   if (!size) size = 1
   closed = (map == "ring" && turn == 360)
   order = (type ~ /[689]/) ? 2 : 1; hollow = (type ~ /8/)
   triangles = (type ~ /[36]/); per = 1 + triangles
   print "*NODE, NSET=" elset
   for (j = 0; j <= order*m - closed; j++) for (i = 0; i <= order*n; i++) if (!(hollow && i % 2 && j % 2)) { node(i, j); printf "%d, %.17g, %.17g\n", id(i, j), px, py }
   print "*ELEMENT, TYPE=" type ", ELSET=" elset
   for (j = 0; j < m; j++) for (i = 0; i < n; i++) {
      a = order*i; b = order*j; c = a + order; d = b + order
      if (triangles) {
         printf "%d, %d, %d, %d", first + 2*(j*n + i) + 1, id(a, b), id(c, b), id(c, d)
         if (order == 2) printf ", %d, %d, %d", id(a + 1, b), id(c, b + 1), id(a + 1, b + 1)
         printf "\n%d, %d, %d, %d", first + 2*(j*n + i) + 2, id(a, b), id(c, d), id(a, d)
         if (order == 2) printf ", %d, %d, %d", id(a + 1, b + 1), id(a + 1, d), id(a, b + 1)
         print ""
         continue
      }
      printf "%d, %d, %d, %d, %d", first + j*n + i + 1, id(a, b), id(c, b), id(c, d), id(a, d)
      if (order == 2) printf ", %d, %d, %d, %d", id(a + 1, b), id(c, b + 1), id(a + 1, d), id(a, b + 1)
      if (order == 2 && !hollow) printf ", %d", id(a + 1, b + 1)
      print ""
   }
   print "*NSET, NSET=" elset "-RIGHT"; for (j = 0; j <= order*m; j++) print id(order*n, j)
   print "*NSET, NSET=" elset "-LEFT"; for (j = 0; j <= order*m; j++) print id(0, j)
   print "*SURFACE, NAME=" elset "-RIGHT, TYPE=ELEMENT"; for (j = 1; j <= m; j++) print first + per*(j*n - 1) + 1 ", S2"
   print "*SURFACE, NAME=" elset "-LEFT, TYPE=ELEMENT"; for (j = 1; j <= m; j++) print first + per*((j - 1)*n + 1) ", S" (5 - per)
   if (closed) exit
   print "*NSET, NSET=" elset "-BOTTOM"; for (i = 0; i <= order*n; i++) print id(i, 0)
   print "*NSET, NSET=" elset "-TOP"; for (i = 0; i <= order*n; i++) print id(i, order*m)
   print "*NSET, NSET=" elset "-OUTLINE\n" elset "-BOTTOM, " elset "-RIGHT, " elset "-TOP, " elset "-LEFT"
   print "*SURFACE, NAME=" elset "-BOTTOM, TYPE=ELEMENT"; for (i = 1; i <= n; i++) print first + per*(i - 1) + 1 ", S1"
   print "*SURFACE, NAME=" elset "-TOP, TYPE=ELEMENT"; for (i = 1; i <= n; i++) print first + per*((m - 1)*n + i) ", S" (4 - per)
   exit
}
