# A pin in the hole of a lug, both rings of straight faces: -v digits=6 -v angle=30 -v faces=24 -v holes=24 -v slave=PIN -v moment=0 -v gap=0
# -v type=CPE4 -v quadrature=NODAL -v force=10 -v hold=0 -v nu=0 -v loose=0. loose: the lug is not held. The pin is pushed along -y of the turned frame at the nodes of its hole.
function put(x) { return sprintf("%." digits "g", x) + 0 == 0 ? "0" : sprintf("%." digits "g", x) }
function ring(name, r1, r2, n, first, element,   i, j, a, r, k) {
   print "*NODE, NSET=" name
   for (j = 0; j < n; j++) for (i = 0; i <= 2; i++) {
      a = 2*pi*j/n + turn; r = r1 + (r2 - r1)*i/2
      print first + 3*j + i ", " put(x0 + r*cos(a)) ", " put(y0 + r*sin(a)) }
   print "*ELEMENT, TYPE=" type ", ELSET=" name
   for (j = 0; j < n; j++) for (i = 0; i < 2; i++) {
      k = (j + 1)%n
      if (type ~ /3/) {
         print element++ ", " first + 3*j + i ", " first + 3*j + i + 1 ", " first + 3*k + i + 1
         print element++ ", " first + 3*j + i ", " first + 3*k + i + 1 ", " first + 3*k + i
      } else print element++ ", " first + 3*j + i ", " first + 3*j + i + 1 ", " first + 3*k + i + 1 ", " first + 3*k + i }
}
function list(name, n, first, i,   j) { print "*NSET, NSET=" name; for (j = 0; j < n; j++) print first + 3*j + i }
BEGIN {
   pi = 4*atan2(1, 1); turn = angle*pi/180
   print "*HEADING\nA pin in the hole of a lug"
   ring("PIN", 0.3, 1, faces, 1, 1)
   ring("LUG", 1 + gap, 2, holes, 10001, 10001)
   print "*SURFACE, NAME=PIN-SIDE"
   for (j = 0; j < faces; j++) print (type ~ /3/) ? 4*j + 3 ", S2" : 2*j + 2 ", S2"
   print "*SURFACE, NAME=LUG-SIDE"
   for (j = 0; j < holes; j++) print (type ~ /3/) ? 10001 + 4*j + 1 ", S3" : 10001 + 2*j ", S4"
   list("BORE", faces, 1, 0); list("OUTSIDE", holes, 10001, 2)
   print "*MATERIAL, NAME=M\n*ELASTIC\n1e5, 0.3\n*SOLID SECTION, ELSET=PIN, MATERIAL=M\n*SOLID SECTION, ELSET=LUG, MATERIAL=M"
   print "*SURFACE INTERACTION, NAME=I\n*FRICTION\n" nu "\n*CONTACT PAIR, INTERACTION=I" ((quadrature != "") ? ", QUADRATURE=" quadrature : "")
   print (slave == "LUG") ? "LUG-SIDE, PIN-SIDE" : "PIN-SIDE, LUG-SIDE"
   if (!loose) print "*BOUNDARY\nOUTSIDE, 1, 2"
   if (loose && hold) print "*BOUNDARY"
   if (hold) print "BORE, 1, 2"
   print "*STEP\n*STATIC\n*CLOAD"
   printf "BORE, 1, %.17g\nBORE, 2, %.17g\n", force/faces*sin(turn), -force/faces*cos(turn)
   if (moment != 0) for (j = 0; j < faces; j++) {
      a = 2*pi*j/faces + turn
      printf "%d, 1, %.17g\n%d, 2, %.17g\n", 1 + 3*j, -moment/faces/0.3*sin(a), 1 + 3*j, moment/faces/0.3*cos(a) }
   print "*NODE PRINT\nU, RF\n*END STEP"
}
