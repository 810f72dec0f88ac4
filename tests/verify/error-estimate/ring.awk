# Lame's ring under inner pressure 1, a quarter of 1 < r < 2, plane strain, E = 1000, mu = 0.3: the deck, or the true error.
#    awk -v order=1|2 -v n=N -f ring.awk </dev/null              prints the deck, n x n elements, nodes on the circles
#    awk -v order=1|2 -v n=N -f ring.awk FOLDER/stress.tab        prints ||e||^2: the exact less the printed stresses in the energy norm
#
# With p on r = a: s_rr = A - B/r^2, s_tt = A + B/r^2, A = p a^2/(b^2 - a^2), B = A b^2; 2 G u_r = (1 - 2 mu) A r + B/r.
function place(i, j,   r, t) { r = 1 + i/m; t = j/m*pi/2; px = r*cos(t); py = r*sin(t) }
function shape(t, k) {                            # values and slopes on the line, k = 0..order
   if (order == 1) { v = k ? (1 + t)/2 : (1 - t)/2; d = k ? 0.5 : -0.5; return }
   if (k == 0) { v = t*(t - 1)/2; d = t - 0.5 } else if (k == 1) { v = 1 - t*t; d = -2*t } else { v = t*(t + 1)/2; d = t + 0.5 }
}
# Weight of a Gauss point of element (ie, je), and its place (gx, gy).
function weigh(ie, je, point,   g, ki, kj, a, b, q, c, w, k, l, vk, dk, vl, dl, j11, j12, j21, j22) {
   g = order + 1; ki = (point - 1) % g; kj = int((point - 1)/g)
   q = (order == 1) ? 1/sqrt(3) : sqrt(0.6); c = (g == 2) ? 2*ki - 1 : ki - 1; a = c*q
   w = (g == 2) ? 1 : (c ? 5/9 : 8/9); c = (g == 2) ? 2*kj - 1 : kj - 1; b = c*q; w *= (g == 2) ? 1 : (c ? 5/9 : 8/9)
   gx = gy = j11 = j12 = j21 = j22 = 0
   for (k = 0; k <= order; k++) { shape(a, k); vk = v; dk = d
      for (l = 0; l <= order; l++) { shape(b, l); vl = v; dl = d
         place(order*ie + k, order*je + l)
         gx += vk*vl*px; gy += vk*vl*py
         j11 += dk*vl*px; j12 += vk*dl*px; j21 += dk*vl*py; j22 += vk*dl*py } }
   return w*(j11*j22 - j12*j21)
}
function deck(   i, j, k, row) {
   print "*HEADING\nLame ring, quarter\n*NODE, NSET=ALL"
   row = m + 1
   for (j = 0; j <= m; j++) for (i = 0; i <= m; i++) { place(i, j); printf "%d, %.17g, %.17g\n", row*j + i + 1, px, py }
   print "*ELEMENT, TYPE=CPE" (order == 1 ? 4 : 9) ", ELSET=RING"
   for (j = 0; j < n; j++) for (i = 0; i < n; i++) {
      k = row*order*j + order*i + 1
      if (order == 1) printf "%d, %d, %d, %d, %d\n", n*j + i + 1, k, k + 1, k + row + 1, k + row
      else printf "%d, %d, %d, %d, %d, %d, %d, %d, %d, %d\n", n*j + i + 1, k, k + 2, k + 2*row + 2, k + 2*row, \
         k + 1, k + row + 2, k + 2*row + 1, k + row, k + row + 1
   }
   print "*NSET, NSET=X, GENERATE\n1, " row "\n*NSET, NSET=Y, GENERATE\n" m*row + 1 ", " row*row
   print "*NSET, NSET=ARCS, GENERATE\n" row + 1 ", " (m - 1)*row + 1 ", " row "\n" 2*row ", " m*row ", " row
   print "*NSET, NSET=ENDS\n1, " row "\n*NSET, NSET=TOPS\n" m*row + 1 ", " row*row
   print "*MATERIAL, NAME=M\n*ELASTIC\n1000, 0.3\n*SOLID SECTION, ELSET=RING, MATERIAL=M"
   print "*PARAMETER\nA = 1/3\nB = 4/3\nG = 1000/2.6\n*BOUNDARY\nX, 2\nY, 1\n*STEP\n*STATIC\n*BOUNDARY, FUNCTION"
   print "ARCS, 1, 1, x*(0.4*A + B/(x*x + y*y))/(2*G)\nARCS, 2, 2, y*(0.4*A + B/(x*x + y*y))/(2*G)"
   print "ENDS, 1, 1, x*(0.4*A + B/(x*x + y*y))/(2*G)\nTOPS, 2, 2, y*(0.4*A + B/(x*x + y*y))/(2*G)"
   print "*EL PRINT\nS\n*END STEP"
}
BEGIN {
   pi = atan2(0, -1); m = order*n
   if (ARGC == 1) { deck(); exit }
}
/^#/ { next }
{
   w = weigh(($2 - 1) % n, int(($2 - 1)/n), $3)
   if ((gx - $4)^2 + (gy - $5)^2 > 1e-24) { print "place"; bad = 1; exit }
   r2 = gx*gx + gy*gy; A = 1/3; B = 4/3
   e11 = A - B*(gx*gx - gy*gy)/r2/r2 - $6
   e22 = A + B*(gx*gx - gy*gy)/r2/r2 - $7
   e12 = -2*B*gx*gy/r2/r2 - $9
   sum += w*(1.3*(0.7*(e11*e11 + e22*e22) - 0.6*e11*e22) + 2.6*e12*e12)/1000
   rows++
}
END { if (ARGC > 1 && !bad) { if (rows == n*n*(order + 1)^2) printf "%.17g\n", sum; else print "rows" } }
