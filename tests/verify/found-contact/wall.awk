# A wall in running bond, fixed at its foot: even courses of `wide` blocks of 2 x 1, odd ones with halves at both ends, head joints;
# nx x ny elements a block; gravity leans to the side by `push`.
#   awk -v wide=43 -v courses=23 -v nx=8 -v law="0.6" -v way=found -f wall.awk
# way=found: *CONTACT finds the joints. way=pairs: the joints are given pair by pair, each with a surface for its half of a bed joint.
# way=sides: as pairs, with the whole bottom or top of a block as slave, of which the other half looks elsewhere: the averages of the
# pressure are over whole bed joints. Blocks are written one by one then, and nothing is searched for.
function name(kind, i, j) { return kind "-" i "-" j }
function block(kind, x, y, w, columns, rows, dx, dy,    i, j) {
   if (way == "found") {
      printf "*BLOCK, TYPE=CPE4, ELSET=%s, NX=%d, NY=%d\n", kind, nx*w/2, ny
      printf "%g, %g\n%g, %g\n%g, %g\n%g, %g\nCOPY, %d, %d, %g, %g\n", x, y, x + w, y, x + w, y + 1, x, y + 1, columns, rows, dx, dy }
   for (j = 1; j <= rows; j++) for (i = 1; i <= columns; i++) {
      n++
      id[n] = name(kind, i, j); left[n] = x + (i - 1)*dx; width[n] = w; low[n] = y + (j - 1)*dy
      at[left[n], low[n]] = n
      if (way == "found") continue
      printf "*BLOCK, TYPE=CPE4, ELSET=%s, NX=%d, NY=%d\n", id[n], nx*w/2, ny
      printf "%g, %g\n%g, %g\n%g, %g\n%g, %g\n", left[n], low[n], left[n] + w, low[n], left[n] + w, low[n] + 1, left[n], low[n] + 1 } }
# The element at the x of a block's bottom or top, counted from 1.
function column(b, x) { return int((x - left[b])*nx/2 + 0.5) + 1 }
# A pair: the part of side `side` of block a from x to y, on the other side of block b.
function bed(a, b, side, x, y,    k, other) {
   if (way == "sides") { pair[++pairs] = id[a] (side == 1 ? "-BOTTOM" : "-TOP") ", " id[b] (side == 1 ? "-TOP" : "-BOTTOM"); return }
   printf "*SURFACE, NAME=J%d\n", ++joints
   for (k = column(a, x); k < column(a, y); k++) printf "%d, S%d\n", first[a] + k - 1 + (side == 3 ? nx*width[a]/2*(ny - 1) : 0), side
   pair[++pairs] = "J" joints ", " id[b] (side == 1 ? "-TOP" : "-BOTTOM") }
# Both halves of a bed joint, from left to right below a block, from right to left on it.
function beds(a, side,    y, k, x, w, b) {
   y = low[a] + (side == 1 ? -1 : 1)
   for (k = 0; k < 2; k++) {
      x = left[a] + (side == 1 ? k : 1 - k)
      if (x >= left[a] + width[a]) continue
      b = ((x, y) in at) ? at[x, y] : ((x - 1, y) in at) ? at[x - 1, y] : 0
      if (b > a) bed(a, b, side, x, x + 1) } }
BEGIN {
   if (!nx) nx = 4; if (!ny) ny = nx/2; if (push == "") push = 0.1
   block("FULL", 0, 0, 2, wide, int((courses + 1)/2), 2, 2)
   block("ODD", 1, 1, 2, wide - 1, int(courses/2), 2, 2)
   block("HALF", 0, 1, 1, 2, int(courses/2), 2*wide - 1, 2)
   for (b = 1; b <= n; b++) { first[b] = e + 1; e += nx*width[b]/2*ny }
   print "*ELSET, ELSET=ALL"
   if (way == "found") print "FULL, ODD, HALF"
   else for (b = 1; b <= n; b++) print id[b]
   print "*MATERIAL, NAME=STONE\n*ELASTIC\n1e6, 0.2\n*DENSITY\n2\n*SOLID SECTION, ELSET=ALL, MATERIAL=STONE"
   print "*SURFACE INTERACTION, NAME=JOINT" (slope ? "\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n" slope : "")
   print "*FRICTION" (law ~ /,.*,/ ? ", NONLOCAL" : "") "\n" law
   if (way == "found") print "*CONTACT\n*CONTACT INCLUSIONS, ALL EXTERIOR\n*CONTACT PROPERTY ASSIGNMENT\n, , JOINT"
   else {
      # the slave is the first block in the deck
      for (b = 1; b <= n; b++) {
         beds(b, 1)
         x = left[b] + width[b]
         if (((x, low[b]) in at) && at[x, low[b]] > b) pair[++pairs] = id[b] "-RIGHT, " id[at[x, low[b]]] "-LEFT"
         for (w = 1; w <= 2; w++) {
            x = left[b] - w
            if (((x, low[b]) in at) && at[x, low[b]] > b && width[at[x, low[b]]] == w)
               pair[++pairs] = id[b] "-LEFT, " id[at[x, low[b]]] "-RIGHT" }
         beds(b, 3) }
      print "*CONTACT PAIR, INTERACTION=JOINT"
      for (k = 1; k <= pairs; k++) print pair[k] }
   print "*BOUNDARY"
   if (way == "found") print "FULL-BOTTOM, 1, 2"
   else for (b = 1; b <= n; b++) if (low[b] == 0) print id[b] "-BOTTOM, 1, 2"
   printf "*STEP\n*STATIC\n*DLOAD\nALL, GRAV, 9.81, %g, -1\n", push
   if (nodes) print "*NODE PRINT\nU"
   print "*END STEP"
}
