# A sector of 40 degrees of a ring from 1 to 2, CPS9, its edges on rollers in radial directions.
BEGIN {
   pi = atan2(0, -1); na = 6; nr = 8
   print "*HEADING\nA sector of a ring\n*NODE, NSET=ALL"
   for (j = 0; j <= 2*nr; j++) for (i = 0; i <= 2*na; i++) {
      t = i/(2*na)*40*pi/180; r = 1 + j/(2*nr)
      printf "%d, %.17g, %.17g\n", ++n, r*cos(t), r*sin(t); place[i, j] = n }
   print "*ELEMENT, TYPE=CPS9, ELSET=ALL"
   for (j = 0; j < nr; j++) for (i = 0; i < na; i++) {
      a = 2*i; b = 2*j
      printf "%d, %d, %d, %d, %d, %d, %d, %d, %d, %d\n", ++e, place[a, b], place[a, b + 2], place[a + 2, b + 2], place[a + 2, b], \
         place[a, b + 1], place[a + 1, b + 2], place[a + 2, b + 1], place[a + 1, b], place[a + 1, b + 1] }
   print "*NSET, NSET=EDGES"
   for (j = 0; j <= 2*nr; j++) printf "%d, %d\n", place[0, j], place[2*na, j]
   print "*SURFACE, NAME=INNER\n1, S4"
   for (i = 2; i <= na; i++) printf "%d, S4\n", i
   print "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*SOLID SECTION, ELSET=ALL, MATERIAL=M\n*TRANSFORM, NSET=ALL, TYPE=C\n0., 0., 0., 0., 0., 1."
   print "*BOUNDARY\nEDGES, 2\n*STEP\n*STATIC\n*DSLOAD\nINNER, P, 10.\n*NODE PRINT\nU, RF\n*END STEP"
}
