# Writes a deck: a cantilever of uneven triangles (8 x 3 squares with moved inner nodes, each cut in two, the cuts in turn).
#    awk -v type=CPE6 -f beam.awk
function corner(i, j,   k, inside) {
   k = j*w + i + 1
   inside = i > 0 && i < n && j > 0 && j < m
   x[k] = i/4 + inside*0.03125*((i*3 + j*5)%4 - 1.5)
   y[k] = j/3 + inside*0.03125*((i*5 + j*3)%4 - 1.5)
   printf "%d, %.10g, %.10g\n", k, x[k], y[k]
}
function cut(i, j,   a, b, c, d, odd) {
   a = j*w + i + 1; b = a + 1; c = b + w; d = a + w; odd = (i + j)%2
   t[++e] = odd ? a " " b " " c : b " " c " " d
   t[++e] = odd ? c " " d " " a : d " " a " " b
   if (j == m - 1) press = press e - !odd ", P" 2 - odd ", 0.5\n"
}
# The middle of a side, made when its first triangle comes.
function middle(p, q,   key) {
   key = p < q ? p " " q : q " " p
   if (key in mid) return mid[key]
   mid[key] = ++N
   printf "%d, %.10g, %.10g\n", N, (x[p] + x[q])/2, (y[p] + y[q])/2
   if (x[p] + x[q] == 0) left = left N "\n"
   return N
}
BEGIN {
   n = 8; m = 3; w = n + 1; N = w*(m + 1)
   print "*HEADING\nBeam of uneven triangles: end force, pressure, weight; CalculiX reads it, too\n*NODE, NSET=ALL"
   for (j = 0; j <= m; j++) for (i = 0; i <= n; i++) corner(i, j)
   for (j = 0; j < m; j++) for (i = 0; i < n; i++) cut(i, j)
   for (k = 1; k <= e; k++) {
      split(t[k], v, " ")
      line[k] = k ", " v[1] ", " v[2] ", " v[3]
      if (type ~ /6/) for (s = 1; s <= 3; s++) line[k] = line[k] ", " middle(v[s], v[s%3 + 1])
   }
   for (j = 0; j <= m; j++) left = left j*w + 1 "\n"
   print "*ELEMENT, TYPE=" type ", ELSET=ALL"
   for (k = 1; k <= e; k++) print line[k]
   printf "*NSET, NSET=ALL-LEFT\n%s*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*DENSITY\n2.\n", left
   print "*SOLID SECTION, ELSET=ALL, MATERIAL=M\n1.\n*BOUNDARY\nALL-LEFT, 1, 2\n*STEP\n*STATIC\n*CLOAD"
   printf "%d, 2, -1.\n%d, 1, 0.7\n*DLOAD\n%sALL, GRAV, 0.1, 0., -1., 0.\n", w, (m + 1)*w, press
   print "*NODE PRINT, NSET=ALL\nU\n*END STEP"
   exit
}
