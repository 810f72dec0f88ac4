# A deck with a *BLOCK of 4 x 4 elements and a floor along x, turned by `angle` degrees: nodes and floor in numbers of `digits` digits.
function place(x, y) {
   return sprintf("%.*g, %.*g", digits, c*x - s*y, digits, s*x + c*y)
}
BEGIN {
   c = cos(angle*atan2(0, -1)/180)
   s = sin(angle*atan2(0, -1)/180)
}
/^\*BLOCK/ {
   print "*NODE"
   for (j = 0; j < 5; j++) for (i = 0; i < 5; i++) print 5*j + i + 1 ", " place(i/4, j/4)
   print "*ELEMENT, TYPE=CPE4, ELSET=CRATE"
   for (j = 0; j < 4; j++) for (i = 0; i < 4; i++) {
      n = 5*j + i + 1
      print 4*j + i + 1 ", " n ", " n + 1 ", " n + 6 ", " n + 5
   }
   split("BOTTOM RIGHT TOP LEFT", side, " ")
   for (k = 1; k <= 4; k++) {
      print "*SURFACE, NAME=CRATE-" side[k]
      for (i = 1; i <= 4; i++) print (k == 1 ? i : k == 2 ? 4*i : k == 3 ? 12 + i : 4*i - 3) ", S" k
   }
   skip = 4
   next
}
skip > 0 {
   skip--
   next
}
/^START/ { print "START, " place(-1, 0); next }
/^LINE/ { print "LINE, " place(2, 0); next }
{ print }
