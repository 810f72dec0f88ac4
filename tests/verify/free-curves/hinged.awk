# A disc that is pressed onto a floor by 20 in its middle, and a bar without load that two equations hang on its rim: -v digits=8 -v angle=57.3
# -v nu=0. Nothing holds the disc's rotation without friction, and that of the bar in any case.
function put(x) { return sprintf("%." digits "g", x) + 0 == 0 ? "0" : sprintf("%." digits "g", x) }
function place(x, y) { return put(c*x - s*y) ", " put(s*x + c*y) }
function block(name, first, n, m, x, y, dx, dy,   i, j, k) {
   print "*NODE"
   for (j = 0; j <= m; j++) for (i = 0; i <= n; i++) print first + (n + 1)*j + i ", " place(x + dx*i/n, y + dy*j/m)
   print "*ELEMENT, TYPE=CPS4, ELSET=" name
   for (j = 0; j < m; j++) for (i = 0; i < n; i++) { k = first + (n + 1)*j + i; print ++e ", " k ", " k + 1 ", " k + n + 2 ", " k + n + 1 }
}
BEGIN {
   pi = 4*atan2(1, 1); c = cos(angle*pi/180); s = sin(angle*pi/180)
   print "*HEADING\nA bar that hangs on a disc"
   block("FLOOR", 1, 12, 3, -1.5, -2, 3, 1); block("BAR", 101, 6, 2, 1.2, -0.1, 1.2, 0.2)
   print "*NODE"
   for (j = 0; j < 32; j++) for (i = 0; i <= 3; i++) { a = 2*pi*j/32; print 201 + 4*j + i ", " place((0.25 + 0.25*i)*cos(a), (0.25 + 0.25*i)*sin(a)) }
   print "*ELEMENT, TYPE=CPS4, ELSET=DISC"
   for (j = 0; j < 32; j++) for (i = 0; i < 3; i++) { k = 201 + 4*j + i; l = 201 + 4*((j + 1)%32) + i; print ++e ", " k ", " k + 1 ", " l + 1 ", " l; if (i == 2) rim[j] = e }
   print "*SURFACE, NAME=RIM"; for (j = 0; j < 32; j++) print rim[j] ", S2"
   print "*SURFACE, NAME=TOP"; for (i = 25; i <= 36; i++) print i ", S3"
   print "*NSET, NSET=HELD, GENERATE\n1, 13\n*NSET, NSET=PRESSED\n233, 297\n*MATERIAL, NAME=M\n*ELASTIC\n1e5, 0.3"
   split("FLOOR BAR DISC", names, " "); for (i = 1; i <= 3; i++) print "*SOLID SECTION, ELSET=" names[i] ", MATERIAL=M"
   for (i = 1; i <= 2; i++) print "*EQUATION\n2\n204, " i ", 1., 108, " i ", -1."
   print "*SURFACE INTERACTION, NAME=I" (nu > 0 ? "\n*FRICTION\n" nu : "") "\n*CONTACT PAIR, INTERACTION=I\nRIM, TOP\n*BOUNDARY\nHELD, 1, 2"
   printf "*STEP\n*STATIC\n*CLOAD\nPRESSED, 1, %.17g\nPRESSED, 2, %.17g\n*NODE PRINT\nU\n*END STEP\n", 10*s, -10*c
}
