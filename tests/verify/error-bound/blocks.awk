# A block on a block, turned, in other units, with other numbers: -v angle=DEGREES -v length_unit=L -v force_unit=F -v reverse=1
# -v rule=', QUADRATURE=MORTAR', -v clearance=S (the lower block is the slave, with a gap of S at its left end, 2 S at the right one);
# -v upper=N (elements of the upper block along the joint; 4 match the lower one's) -v type=CPE4 or CPE9.
function at(node) { return reverse ? 5000 - 7*node : node }
function grid(first, nx, ny, x0, y0, x1, y1,    i, j) {
   for (j = 0; j <= ny; j++) for (i = 0; i <= nx; i++) {
      x = (x0 + (x1 - x0)*i/nx)*length_unit
      y = (y0 + (y1 - y0)*j/ny)*length_unit
      place[first + j*(nx + 1) + i] = sprintf("%.17g, %.17g", c*x - s*y, s*x + c*y)
   }
}
function elements(first, nx, ny, name, element,    i, j, n, k) {
   print "*ELEMENT, TYPE=" type ", ELSET=" name
   for (j = 0; j < ny; j += p) for (i = 0; i < nx; i += p) {
      n = first + j*(nx + 1) + i
      k = nx + 1
      line = (reverse ? 900 - element : element) ", " at(n) ", " at(n + p) ", " at(n + p*k + p) ", " at(n + p*k)
      if (p == 2) line = line ", " at(n + 1) ", " at(n + k + 2) ", " at(n + 2*k + 1) ", " at(n + k) ", " at(n + k + 1)
      print line
      if (j == 0) bottom[name] = bottom[name] (reverse ? 900 - element : element) ", S1\n"
      if (j == ny - p) top[name] = top[name] (reverse ? 900 - element : element) ", S3\n"
      element++
   }
   return element
}
BEGIN {
   if (!length_unit) length_unit = 1
   if (!force_unit) force_unit = 1
   if (!upper) upper = 4
   pair = clearance == "" ? "UPPER-BOTTOM, LOWER-TOP" : "LOWER-TOP, UPPER-BOTTOM"
   if (!type) type = "CPE4"
   p = type == "CPE9" ? 2 : 1
   c = cos(angle*atan2(0, -1)/180)
   s = sin(angle*atan2(0, -1)/180)
   stress = force_unit/length_unit^2
   print "*HEADING\na block on a block"
   grid(1, 4*p, 2*p, 0, 0, 2, 1)
   grid(101, upper*p, 2*p, 0.25, 1, 1.75, 1.8)
   print "*NODE"
   for (node in place) print at(node) ", " place[node]
   e = elements(1, 4*p, 2*p, "LOWER", 1)
   elements(101, upper*p, 2*p, "UPPER", e)
   print "*SURFACE, NAME=LOWER-TOP\n" top["LOWER"] "*SURFACE, NAME=UPPER-BOTTOM\n" bottom["UPPER"] "*SURFACE, NAME=UPPER-TOP\n" top["UPPER"]
   printf "*MATERIAL, NAME=SOFT\n*ELASTIC\n%.17g, 0.3\n*DENSITY\n%.17g\n", 100*stress, 0.1*stress/length_unit
   printf "*MATERIAL, NAME=HARD\n*ELASTIC\n%.17g, 0.2\n", 300*stress
   printf "*SOLID SECTION, ELSET=LOWER, MATERIAL=SOFT\n%.17g\n*SOLID SECTION, ELSET=UPPER, MATERIAL=HARD\n%.17g\n", length_unit, length_unit
   printf "*SURFACE INTERACTION, NAME=JOINT\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=PENALTY\n%.17g\n", 1e-5*length_unit/stress
   printf "*FRICTION, NONLOCAL\n0.3, %.17g, 0.\n*CONTACT PAIR, INTERACTION=JOINT%s\n%s\n", 1e-3*length_unit, rule, pair
   if (clearance != "") {
      print "*CLEARANCE, SLAVE=LOWER-TOP, MASTER=UPPER-BOTTOM, TABULAR"
      for (i = 0; i <= 4*p; i++) printf "%d, %.17g\n", at(2*p*(4*p + 1) + 1 + i), clearance*(1 + i/(4*p))
   }
   print "*BOUNDARY"
   for (i = 1; i <= 4*p + 1; i++) print at(i) ", 1, 2"
   # the upper block is held by contact alone: a load that is not in its middle, friction, and the weight of the lower one
   printf "*STEP\n*STATIC\n*DSLOAD\nUPPER-TOP, P, %.17g\nUPPER-TOP, TRVEC, %.17g, %.17g, %.17g\n", stress, 0.1*stress, c, s
   printf "*DLOAD\nLOWER, GRAV, 1., %.17g, %.17g\n*NODE PRINT\nU\n*END STEP\n", s, -c
}
