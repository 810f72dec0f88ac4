# A roller between two races: -v digits=6 -v angle=30 -v type=CPE4. The outer one is held round its rim; the inner one hangs in four weak springs and
# presses the roller with 20.
function put(x) { return sprintf("%." digits "g", x) + 0 == 0 ? "0" : sprintf("%." digits "g", x) }
function place(x, y) { return put(c*x - s*y) ", " put(s*x + c*y) }
# ring NAME FIRST: n by m elements between two radii round (0, y), counter-clockwise from below; LOW and HIGH are its faces, in and out.
function ring(name, first, n, m, inner, outer, y,   i, j, a, r, k, list) {
   print "*NODE"
   for (j = 0; j < n; j++) for (i = 0; i <= m; i++) { a = 2*pi*j/n - pi/2; r = inner + (outer - inner)*i/m; print first + (m + 1)*j + i ", " place(r*cos(a), y + r*sin(a)) }
   print "*ELEMENT, TYPE=" type ", ELSET=" name
   for (j = 0; j < n; j++) for (i = 0; i < m; i++) {
      k = first + (m + 1)*((j + 1)%n) + i; a = first + (m + 1)*j + i
      if (type == "CPE3") { print ++e ", " a ", " a + 1 ", " k + 1; if (i == m - 1) rim[j] = e; print ++e ", " a ", " k + 1 ", " k; if (i == 0) bore[j] = e }
      else { print ++e ", " a ", " a + 1 ", " k + 1 ", " k; if (i == m - 1) rim[j] = e; if (i == 0) bore[j] = e }
   }
   print "*SURFACE, NAME=" name "-HIGH"; for (j = 0; j < n; j++) print rim[j] ", S2"
   print "*SURFACE, NAME=" name "-LOW"; for (j = 0; j < n; j++) print bore[j] ", " (type == "CPE3" ? "S3" : "S4")
   print "*NSET, NSET=" name "-RIM"; for (j = 0; j < n; j++) print first + (m + 1)*j + m
   print "*NSET, NSET=" name "-BORE"; for (j = 0; j < n; j++) print first + (m + 1)*j
}
BEGIN {
   pi = 4*atan2(1, 1); c = cos(angle*pi/180); s = sin(angle*pi/180)
   print "*HEADING\nA roller between two races"
   ring("OUT", 1, 40, 2, 2, 2.6, 0); ring("IN", 1001, 32, 2, 0.7, 1.2, 0); ring("ROLLER", 2001, 24, 3, 0.1, 0.4, -1.6)
   print "*MATERIAL, NAME=M\n*ELASTIC\n1e5, 0.3"
   split("OUT IN ROLLER", names, " "); for (i = 1; i <= 3; i++) print "*SOLID SECTION, ELSET=" names[i] ", MATERIAL=M"
   print "*SURFACE INTERACTION, NAME=I\n*CONTACT PAIR, INTERACTION=I\nROLLER-HIGH, OUT-LOW\n*CONTACT PAIR, INTERACTION=I\nROLLER-HIGH, IN-HIGH"
   for (i = 1; i <= 2; i++) print "*ELEMENT, TYPE=SPRING1, ELSET=K" i "\n" 9000 + 2*i ", 1025\n" 9001 + 2*i ", 1073\n*SPRING, ELSET=K" i "\n" i "\n10."
   printf "*BOUNDARY\nOUT-RIM, 1, 2\n*STEP\n*STATIC\n*CLOAD\nIN-BORE, 1, %.17g\nIN-BORE, 2, %.17g\n*NODE PRINT\nU\n*CONTACT PRINT\n*END STEP\n", 20/32*s, -20/32*c
}
