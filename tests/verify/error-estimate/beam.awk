# Timoshenko's cantilever as in tests/verify/cantilever: L = 8, D = 2, P = 1, E = 1000, mu = 0.3, plane stress; exact tractions on
# both ends as consistent forces, three supports against rigid motion.
#    awk -v order=1|2 -v nx=NX -v ny=NY -f beam.awk </dev/null     prints the deck
function add(i, j, fx, fy) { f[i, j, 1] += fx; f[i, j, 2] += fy }
function value(k, t) {                            # shape function k of the side at t in [0, 1]
   if (order == 1) return k ? t : 1 - t
   return (k == 0) ? (1 - t)*(1 - 2*t) : (k == 1) ? 4*t*(1 - t) : t*(2*t - 1)
}
BEGIN {
   print "*HEADING\nTimoshenko cantilever\n*BLOCK, TYPE=CPS" (order == 1 ? 4 : 9) ", ELSET=BEAM, NX=" nx ", NY=" ny
   print "0, -1\n8, -1\n8, 1\n0, 1\n*MATERIAL, NAME=M\n*ELASTIC\n1000, 0.3\n*SOLID SECTION, ELSET=BEAM, MATERIAL=M"
   mx = order*nx; my = order*ny; row = mx + 1; h = 2/ny
   print "*BOUNDARY\n" row*my/2 + 1 ", 1, 2\n" row*my + 1 ", 1\n*STEP\n*STATIC\n*CLOAD"
   # three Gauss points: a parabola times a parabola is exact
   for (j = 0; j < ny; j++) for (g = -1; g <= 1; g++) {
      t = 0.5*(1 + g*sqrt(0.6)); y = -1 + (j + t)*h
      for (k = 0; k <= order; k++) {
         w = h*(g ? 5 : 8)/18*value(k, t)
         add(mx, order*j + k, 0, w*0.75*(1 - y*y))
         add(0, order*j + k, w*12*y, -w*0.75*(1 - y*y))
      }
   }
   for (j = 0; j <= my; j++) for (i = 0; i <= mx; i += mx) for (d = 1; d <= 2; d++)
      if (f[i, j, d] != 0) printf "%d, %d, %.17g\n", j*row + i + 1, d, f[i, j, d]
   print "*END STEP"
}
