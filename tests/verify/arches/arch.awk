# A semicircular arch of n voussoirs with straight sides, corners on circles of radius 1 -+ t/2, on a rigid floor, under its own weight:
# awk -v n=9 -v t=0.11 -v nu=1 -v across=1 -f arch.awk
function corner(k, r,   a) { # on the ray k, 0 .. n from the left
   a = pi*(1 - k/n)
   printf "%.17g, %.17g\n", r*cos(a), (k == 0 || k == n) ? 0 : r*sin(a)
}
BEGIN {
   pi = atan2(0, -1)
   for (k = 1; k <= n; k++) {
      printf "*BLOCK, TYPE=CPE4, ELSET=V%d, NX=1, NY=%d\n", k, across
      corner(k - 1, 1 - t/2); corner(k, 1 - t/2); corner(k, 1 + t/2); corner(k - 1, 1 + t/2)
   }
   print "*MATERIAL, NAME=STONE\n*ELASTIC\n1e6, 0.2"
   for (k = 1; k <= n; k++) printf "*SOLID SECTION, ELSET=V%d, MATERIAL=STONE\n1\n", k
   print "*SURFACE, NAME=GROUND, TYPE=SEGMENTS\nSTART, -2, 0\nLINE, 2, 0\n*RIGID BODY, ANALYTICAL SURFACE=GROUND"
   printf "*SURFACE INTERACTION, NAME=JOINT\n*FRICTION\n%s\n*CONTACT PAIR, INTERACTION=JOINT\n", nu
   print "V1-LEFT, GROUND"
   for (k = 2; k <= n; k++) printf "V%d-LEFT, V%d-RIGHT\n", k, k - 1
   printf "V%d-RIGHT, GROUND\n*STEP\n*STATIC\n*DLOAD\n", n
   for (k = 1; k <= n; k++) printf "V%d, BY, -1\n", k
   print "*NODE PRINT\nU\n*CONTACT PRINT\n*END STEP"
}
