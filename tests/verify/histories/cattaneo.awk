# Two equal cylinders of radius 20 that touch in a line, E = 1000, mu = 0.3, nu = 0.3: a deck whose steps follow from standard input.
#
#    awk -v type=CPE4 -v n=24 -v interaction='*FRICTION/0.3' -f cattaneo.awk <loop.steps
#
# Each is 20 wide and 10 high; turned by half a turn about the origin one is the other, so a shear force does not change the pressure to the
# first order. The base of the lower one is held; the top of the upper one is rigid and does not turn: REF is its node, which takes the
# forces. The force 3.8838 makes a = 0.3; n elements a, three times as far as a is long. slave=B: the lower one is the slave.
# depth=4: the elements at the contact are 1/4 as high as long.
function side(x) { x = x < 0 ? -x : x; return x < 3 ? x*x/(20 + sqrt(400 - x*x)) : 9/(20 + sqrt(391)) + (x - 3)*3/sqrt(391) }
# Places 0, h, .. up to `fine`, then growing up to 10, with the middles for eight nodes: line[0..count].
function make_line(line, h, fine,    k, x, count, j) {
   k = 0
   x[0] = 0
   while (x[k] < 10 - 1e-12) {
      if (x[k] > fine - h/2) h *= 1.15
      k++
      x[k] = x[k - 1] + h
      if (x[k] > 10 - h/2) x[k] = 10
   }
   count = 0
   line[0] = 0
   for (j = 1; j <= k; j++) {
      if (middle) line[++count] = (x[j - 1] + x[j])/2
      line[++count] = x[j]
   }
   return count
}
# sign 1: the upper one. Rows are counted away from the contact; left to right.
function make_body(name, sign,    i, j, k, x, y, c, low, high, face, rest) {
   print "*NODE"
   for (j = 0; j <= ny; j++) for (i = -nx; i <= nx; i++) if (!middle || (i + nx)%2 == 0 || j%2 == 0) {
      x = i < 0 ? -along[-i] : along[i]
      printf "%d, %.12g, %.12g\n", first + j*row + i + nx, x, sign*((1 - up[j]/10)*side(x) + up[j])
   }
   print "*ELEMENT, TYPE=" type ", ELSET=" name
   for (j = 0; j < ny; j += q) for (i = 0; i < 2*nx; i += q) {
      c = first + j*row + i
      low = sign > 0 ? c : c + q*row
      high = sign > 0 ? c + q*row : c
      printf "%d, %d, %d, %d, %d", ++cells, low, low + q, high + q, high
      if (middle) printf ", %d, %d, %d, %d", low + 1, c + row + 2, high + 1, c + row
      printf "\n"
      x = (i < nx ? along[nx - i] : along[i - nx])
      if (j == 0 && x < 1) face = face cells ", S" (sign > 0 ? 1 : 3) "\n"
   }
   printf "*SURFACE, NAME=%s-FACE, TYPE=ELEMENT\n%s*NSET, NSET=%s\n", name, face, (sign > 0 ? "REST" : "BASE")
   c = first + ny*row
   for (i = 0; i <= 2*nx; i++) if (sign < 0 || i != nx) print c + i
   if (sign > 0) print "*NSET, NSET=REF\n" c + nx
   print "*SOLID SECTION, ELSET=" name ", MATERIAL=M\n1."
   first += row*(ny + 1)
}
BEGIN {
   middle = type ~ /8/
   q = middle ? 2 : 1
   first = 1
   nx = make_line(along, 0.3/n, 0.45)
   if (!depth) depth = 1
   ny = make_line(up, 0.3/n/depth, 0.15/depth)
   row = 2*nx + 1
   print "*HEADING\ntwo equal cylinders, pressed and pushed"
   make_body("A", 1)
   make_body("B", -1)
   print "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*SURFACE INTERACTION, NAME=ROUGH"
   gsub("/", "\n", interaction)
   print interaction
   print "*CONTACT PAIR, INTERACTION=ROUGH"
   print slave == "B" ? "B-FACE, A-FACE" : "A-FACE, B-FACE"
   print "*EQUATION"
   for (j = 1; j <= 2; j++) printf "2\nREST, %d, 1., REF, %d, -1.\n", j, j
   print "*BOUNDARY\nBASE, 1, 2"
   while ((getline line) > 0) print line
}
