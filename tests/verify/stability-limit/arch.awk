# The arches of ../arches with t and nu as parameters of the deck: awk -v n=9 -f arch.awk
function corner(k, r,   a) { # on the ray k, 0 .. n from the left; r is i or o
   print "<x" r k ">, <y" r k ">"
}
BEGIN {
   pi = atan2(0, -1)
   print "*PARAMETER\nt = 0.2\nnu = 1\nri = 1 - t/2\nro = 1 + t/2"
   for (k = 0; k <= n; k++) {
      a = pi*(1 - k/n)
      c = sprintf("%.17g", cos(a)); s = (k == 0 || k == n) ? "0" : sprintf("%.17g", sin(a))
      print "xi" k " = ri*(" c ")\nyi" k " = ri*(" s ")\nxo" k " = ro*(" c ")\nyo" k " = ro*(" s ")"
   }
   for (k = 1; k <= n; k++) {
      printf "*BLOCK, TYPE=CPE4, ELSET=V%d, NX=1, NY=1\n", k
      corner(k - 1, "i"); corner(k, "i"); corner(k, "o"); corner(k - 1, "o")
   }
   print "*MATERIAL, NAME=STONE\n*ELASTIC\n1e6, 0.2"
   for (k = 1; k <= n; k++) printf "*SOLID SECTION, ELSET=V%d, MATERIAL=STONE\n1\n", k
   print "*SURFACE, NAME=GROUND, TYPE=SEGMENTS\nSTART, -2, 0\nLINE, 2, 0\n*RIGID BODY, ANALYTICAL SURFACE=GROUND"
   print "*SURFACE INTERACTION, NAME=JOINT\n*FRICTION\n<nu>\n*CONTACT PAIR, INTERACTION=JOINT\nV1-LEFT, GROUND"
   for (k = 2; k <= n; k++) printf "V%d-LEFT, V%d-RIGHT\n", k, k - 1
   printf "V%d-RIGHT, GROUND\n*STEP\n*STATIC\n*DLOAD\n", n
   for (k = 1; k <= n; k++) printf "V%d, BY, -1\n", k
   print "*END STEP"
}
