# Two rollers of 32 straight faces between two plates, each on one node of its rim: -v digits=6 -v angle=30 -v nu=0.3. The lower plate is held, the
# upper one is pressed by 6 across itself, so that each roller bears 3: nothing drives it along, but for the last digits of the places.
function put(x) { return sprintf("%." digits "g", x) + 0 == 0 ? "0" : sprintf("%." digits "g", x) }
function place(x, y) { return put(c*x - s*y + 0.3) ", " put(s*x + c*y - 0.2) }
function plate(name, y, first,   i, j) {
   print "*NODE, NSET=" name "-ALL"
   for (j = 0; j <= 2; j++) for (i = 0; i <= 32; i++) print first + 33*j + i ", " place(-4 + 0.25*i, y + 0.5*j)
   print "*ELEMENT, TYPE=CPE4, ELSET=" name
   for (j = 0; j < 2; j++) for (i = 0; i < 32; i++) { k = first + 33*j + i; print ++e ", " k ", " k + 1 ", " k + 34 ", " k + 33 }
}
function roller(name, x, first,   i, j, a, k) {
   print "*NODE"
   for (j = 0; j < n; j++) for (i = 0; i <= 2; i++) { a = 2*pi*j/n - pi/2; print first + 3*j + i ", " place(x + (0.4 + 0.3*i)*cos(a), 1 + (0.4 + 0.3*i)*sin(a)) }
   print "*ELEMENT, TYPE=CPE4, ELSET=" name
   for (j = 0; j < n; j++) for (i = 0; i < 2; i++) { k = (j + 1)%n; print ++e ", " first + 3*j + i ", " first + 3*j + i + 1 ", " first + 3*k + i + 1 ", " first + 3*k + i; if (i) rim[j] = e }
   print "*SURFACE, NAME=" name "-LOW"; for (j = -5; j < 5; j++) print rim[(j + n)%n] ", S2"
   print "*SURFACE, NAME=" name "-HIGH"; for (j = n/2 - 5; j < n/2 + 5; j++) print rim[j] ", S2"
}
function faces(name, first, face,   i) { print "*SURFACE, NAME=" name; for (i = 0; i < 32; i++) print first + i ", " face }
BEGIN {
   pi = 4*atan2(1, 1); c = cos(angle*pi/180); s = sin(angle*pi/180); n = 32
   print "*HEADING\nTwo rollers between plates"
   plate("DOWN", -1, 1); plate("UP", 2, 1001); roller("A", -2, 2001); roller("B", 2, 3001)
   faces("FLOOR", 33, "S3"); faces("CEILING", 65, "S1")
   print "*NSET, NSET=HELD, GENERATE\n1, 33\n*NSET, NSET=PRESSED, GENERATE\n1067, 1099"
   print "*MATERIAL, NAME=M\n*ELASTIC\n1e3, 0.3"
   split("DOWN UP A B", names, " "); for (i = 1; i <= 4; i++) print "*SOLID SECTION, ELSET=" names[i] ", MATERIAL=M"
   print "*SURFACE INTERACTION, NAME=I" (nu > 0 ? "\n*FRICTION\n" nu : "")
   for (i = 3; i <= 4; i++) print "*CONTACT PAIR, INTERACTION=I\n" names[i] "-LOW, FLOOR\n*CONTACT PAIR, INTERACTION=I\n" names[i] "-HIGH, CEILING"
   printf "*BOUNDARY\nHELD, 1, 2\n*STEP\n*STATIC\n*CLOAD\nPRESSED, 1, %.17g\nPRESSED, 2, %.17g\n*NODE PRINT\nU\n*END STEP\n", 6/33*s, -6/33*c
}
