# Writes a deck: layers of height 1 and length `len` one on the other, turned by `angle` degrees, meshed each in its own way.
#    awk -v layers="CPE4:3 CPE9:2:7" -v angle=30 [-v roles=0 -v law=HARD -v nu=0 -v rho=0 -v len=2 -v rows=2 -v load=uniform
#        -v p=10 -v shear=0 -v sides=0 -v slide=0 -v mu=0 -v quadrature=MORTAR] -f stack.awk
# layers (triangles: two to a square): TYPE:N, or TYPE:N:SEED for N elements whose ends lie at random, 0.4 to 1.6 of a mean element apart; the lowest first
# roles: 0: the upper side of each joint is the slave, 1: the lower one
# law: HARD, PENALTY or LINEAR with a compliance of 1e-5
# load: uniform  the pressure p on the upper side of the stack
#       wave     p (1 + cos(pi x/len)/2), by consistent nodal forces
# shear: a traction along the upper side, in parts of the pressure, by nodal forces; nu: friction, with rho nonlocal
# mu: Poisson's ratio; if not 0, the lowest side slides along, and the left ones across, the stack (*TRANSFORM)
# sides=1: the same traction on the sides of all layers, so that a uniform shear stress is in equilibrium
# slide: displacement along x1 that the upper side is given, instead of the traction there
function random() { seed = (seed*16807)%2147483647; return seed/2147483647 }
function place(x, y) { return sprintf("%.17g, %.17g", co*x - si*y, si*x + co*y) }
function node(k, i, j) { return k*1000000 + j*(order*n + 1) + i + 1 }
function x_of(i) { return order == 1 || i%2 == 0 ? cut[i/order] : (cut[(i - 1)/2] + cut[(i + 1)/2])/2 }
function cut_layer(   i, at) {
   cut[0] = 0
   for (i = 1; i <= n; i++) cut[i] = cut[i - 1] + (seeded ? 0.4 + 1.2*random() : 1)
   for (i = 1; i <= n; i++) cut[i] *= len/cut[n]
   if (!seeded) for (i = 1; i <= n; i++) cut[i] = len*i/n
}
function write_layer(k,   i, j, a, c) {
   print "*NODE"
   for (j = 0; j <= order*rows; j++) for (i = 0; i <= order*n; i++) if (centred || i%2 == 0 || j%2 == 0)
      print node(k, i, j) ", " place(x_of(i), k - 1 + j/(order*rows))
   print "*ELEMENT, TYPE=" type ", ELSET=L" k
   for (j = 0; j < rows; j++) for (i = 0; i < n; i++) {
      a = order*i; c = order*j
      if (triangles) {
         printf "%d, %d, %d, %d", k*1000000 + 2*(j*n + i) + 1, node(k, a, c), node(k, a + order, c), node(k, a + order, c + order)
         if (order == 2) printf ", %d, %d, %d", node(k, a + 1, c), node(k, a + 2, c + 1), node(k, a + 1, c + 1)
         printf "\n%d, %d, %d, %d", k*1000000 + 2*(j*n + i) + 2, node(k, a, c), node(k, a + order, c + order), node(k, a, c + order)
         if (order == 2) printf ", %d, %d, %d", node(k, a + 1, c + 1), node(k, a + 1, c + 2), node(k, a, c + 1)
         print ""
         continue
      }
      printf "%d, %d, %d, %d, %d", k*1000000 + j*n + i + 1, node(k, a, c), node(k, a + order, c), node(k, a + order, c + order), \
         node(k, a, c + order)
      if (order == 2) printf ", %d, %d, %d, %d", node(k, a + 1, c), node(k, a + 2, c + 1), node(k, a + 1, c + 2), node(k, a, c + 1)
      print (order == 2 && centred) ? ", " node(k, a + 1, c + 1) : ""
   }
   print "*SURFACE, NAME=B" k; for (i = 1; i <= n; i++) print k*1000000 + per*(i - 1) + 1 ", S1"
   print "*SURFACE, NAME=T" k; for (i = 1; i <= n; i++) print k*1000000 + per*((rows - 1)*n + i) ", S" (4 - per)
   print "*NSET, NSET=T" k; for (i = 0; i <= order*n; i++) print node(k, i, order*rows)
   print "*NSET, NSET=A" k; for (j = 0; j <= order*rows; j++) print node(k, 0, j)
   if (k == 1) { print "*NSET, NSET=BASE"; for (i = 0; i <= order*n; i++) print node(k, i, 0) }
   print "*SOLID SECTION, ELSET=L" k ", MATERIAL=M"
   if (sides) for (j = 0; j <= order*rows; j++) {
      a = shear*p/(order*rows)*((order == 1) ? 1 : (j%2) ? 4/3 : 2/3)
      if (j == 0 || j == order*rows) a /= 2
      side[++n_side] = node(k, 0, j); side_force[n_side] = -a
      side[++n_side] = node(k, order*n, j); side_force[n_side] = a
   }
}
# Nodal forces of the pressure and the shear on the upper side, by five Gauss points a face.
function write_forces(   e, g, a, x, t, w, q, shape) {
   split("-0.906179845938664 -0.538469310105683 0 0.538469310105683 0.906179845938664", gauss, " ")
   split("0.236926885056189 0.478628670499366 0.568888888888889 0.478628670499366 0.236926885056189", weight, " ")
   for (e = 0; e < n; e++) for (g = 1; g <= 5; g++) {
      t = gauss[g]; x = cut[e] + (1 + t)/2*(cut[e + 1] - cut[e])
      w = weight[g]*(cut[e + 1] - cut[e])/2
      q = (load == "wave") ? p*(1 + cos(3.14159265358979324*x/len)/2) : p
      if (order == 1) { shape[0] = (1 - t)/2; shape[1] = (1 + t)/2 }
      else { shape[0] = t*(t - 1)/2; shape[1] = 1 - t*t; shape[2] = t*(t + 1)/2 }
      for (a = 0; a <= order; a++) force[order*e + a] += w*q*shape[a]
   }
   print "*CLOAD"
   for (a = 0; a <= order*n; a++) {
      if (!slide) printf "%d, 1, %.17g\n", node(k, a, order*rows), force[a]*(si + shear*co)
      printf "%d, 2, %.17g\n", node(k, a, order*rows), force[a]*((slide ? 0 : shear*si) - co)
   }
   for (a = 1; a <= n_side; a++) {
      printf "%d, 1, %.17g\n", side[a], -si*side_force[a]
      printf "%d, 2, %.17g\n", side[a], co*side_force[a]
   }
}
BEGIN {
   if (!len) len = 2
   if (!rows) rows = 2
   if (!p) p = 10
   if (law == "") law = "HARD"
   if (quadrature == "") quadrature = "MORTAR"
   co = cos(angle*atan2(0, -1)/180); si = sin(angle*atan2(0, -1)/180)
   print "*HEADING\na stack whose sides do not match\n*MATERIAL, NAME=M\n*ELASTIC\n1000, " mu + 0
   n_layers = split(layers, list, " ")
   for (k = 1; k <= n_layers; k++) {
      seeded = (split(list[k], what, ":") == 3); type = what[1]; n = what[2]; seed = what[3]
      order = (type ~ /[689]/) ? 2 : 1; centred = (type !~ /8/); triangles = (type ~ /[36]/); per = 1 + triangles
      cut_layer(); write_layer(k)
   }
   k = n_layers
   if (mu) {
      print "*NSET, NSET=INCLINED"; for (i = 1; i <= k; i++) print "A" i; print "BASE"
      printf "*TRANSFORM, NSET=INCLINED\n%.17g, %.17g, 0, %.17g, %.17g, 0\n", co, si, -si, co
   }
   print "*SURFACE INTERACTION, NAME=R"
   if (law == "PENALTY") print "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=PENALTY\n1e-5"
   if (law == "LINEAR") print "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1e5"
   if (nu) print "*FRICTION" (rho ? ", NONLOCAL\n" nu ", 0, " rho : "\n" nu)
   print "*CONTACT PAIR, INTERACTION=R, QUADRATURE=" quadrature
   for (i = 1; i < n_layers; i++) print (roles == 0) ? "B" i + 1 ", T" i : "T" i ", B" i + 1
   print "*STEP\n*STATIC"
   if (nu) print "*CONTROLS, TOLERANCE=1e-13"
   print "*BOUNDARY\nBASE, " (mu ? 2 : "1, 2")
   if (mu) for (i = 1; i <= n_layers; i++) print "A" i ", 1"
   if (slide) print "T" k ", 1, 1, " slide
   if (load == "wave" || shear) write_forces(); else print "*DSLOAD\nT" k ", P, " p
   print "*NODE PRINT\nU\n*EL PRINT\nS\n*CONTACT PRINT\n*BODY PRINT\n*JOINT PRINT\n*END STEP"
   exit
}
