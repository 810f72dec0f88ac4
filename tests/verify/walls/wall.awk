# A wall in running bond on a rigid floor: blocks of 2 x 1 of two elements, every second course begins with a half; head joints; weight 1,
# pushed to the right by `factor` of it: awk -v courses=4 -v len=4 -v nu=5 -v factor=0.9 -f wall.awk; -v shift=1: the other courses begin
# with a half; -v height=0.875: of a course
BEGIN {
   if (!height) height = 1
   for (r = 0; r < courses; r++) {
      x = 0
      while (x < len) {
         w = ((r + shift) % 2 == 1 && x == 0) ? 1 : 2
         if (x + w > len) w = len - x
         n++
         course[n] = r; from[n] = x; to[n] = x + w
         x += w } }
   for (i = 1; i <= n; i++) {
      printf "*BLOCK, TYPE=CPE4, ELSET=B%d, NX=%d, NY=1\n", i, to[i] - from[i]
      low = height*course[i]; high = height*(course[i] + 1)
      printf "%d, %g\n%d, %g\n%d, %g\n%d, %g\n", from[i], low, to[i], low, to[i], high, from[i], high }
   print "*MATERIAL, NAME=STONE\n*ELASTIC\n1e6, 0.2"
   for (i = 1; i <= n; i++) printf "*SOLID SECTION, ELSET=B%d, MATERIAL=STONE\n1\n", i
   printf "*SURFACE, NAME=FLOOR, TYPE=SEGMENTS\nSTART, -1, 0\nLINE, %d, 0\n*RIGID BODY, ANALYTICAL SURFACE=FLOOR\n", len + 1
   printf "*SURFACE INTERACTION, NAME=JOINT\n*FRICTION\n%s\n*CONTACT PAIR, INTERACTION=JOINT\n", nu
   for (i = 1; i <= n; i++) {
      if (course[i] == 0) printf "B%d-BOTTOM, FLOOR\n", i
      for (j = 1; j < i; j++) {
         if (course[j] == course[i] - 1 && from[i] < to[j] && from[j] < to[i]) printf "B%d-BOTTOM, B%d-TOP\n", i, j
         if (course[j] == course[i] && to[j] == from[i]) printf "B%d-LEFT, B%d-RIGHT\n", i, j } }
   print "*STEP\n*STATIC\n*DLOAD"
   for (i = 1; i <= n; i++) printf "B%d, BX, %s\nB%d, BY, -1\n", i, factor, i
   print "*NODE PRINT\nU\n*CONTACT PRINT\n*END STEP"
}
