# A chain of blocks pushed against its first one, which is held, and a block above the fourth that is put there in step 1 and let go in
# step 2: -v blocks=105.
BEGIN {
   print "*HEADING\nA chain, and a block that is let go\n*NODE"
   for (b = 0; b <= blocks; b++) {
      x = (b < blocks) ? b : 3; y = (b < blocks) ? 0 : 1.5
      printf "%d, %g, %g\n%d, %g, %g\n%d, %g, %g\n%d, %g, %g\n", 4*b + 1, x, y, 4*b + 2, x + 1, y, 4*b + 3, x + 1, y + 1, 4*b + 4, x, y + 1 }
   for (b = 0; b <= blocks; b++)
      printf "*ELEMENT, TYPE=CPE4, ELSET=%s\n%d, %d, %d, %d, %d\n", (b < blocks) ? "CHAIN" : "LOOSE", b + 1, 4*b + 1, 4*b + 2, 4*b + 3, 4*b + 4
   print "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*SOLID SECTION, ELSET=CHAIN, MATERIAL=M\n1.\n*SOLID SECTION, ELSET=LOOSE, MATERIAL=M\n1."
   for (b = 1; b <= blocks; b++) printf "*SURFACE, NAME=R%d\n%d, S2\n*SURFACE, NAME=L%d\n%d, S4\n", b, b, b, b
   printf "*SURFACE, NAME=TOP\n4, S3\n*SURFACE, NAME=BOTTOM\n%d, S1\n", blocks + 1
   print "*SURFACE INTERACTION, NAME=I\n*FRICTION\n0.5"
   for (b = 1; b < blocks; b++) printf "*CONTACT PAIR, INTERACTION=I\nR%d, L%d\n", b, b + 1
   print "*SURFACE INTERACTION, NAME=J\n*CONTACT PAIR, INTERACTION=J\nBOTTOM, TOP"
   printf "*NSET, NSET=WALL\n1, 4\n*NSET, NSET=LOOSE\n%d, %d, %d, %d\n", 4*blocks + 1, 4*blocks + 2, 4*blocks + 3, 4*blocks + 4
   print "*BOUNDARY\nWALL, 1, 2\n*STEP\n*STATIC\n*BOUNDARY\nLOOSE, 1, 1, 0.1\nLOOSE, 2, 2, 0.2\n*DLOAD"
   printf "%d, P2, 10.\n*NODE PRINT\nU\n*END STEP\n", blocks
   print "*STEP\n*STATIC\n*BOUNDARY, OP=NEW\nWALL, 1, 2\n*NODE PRINT\nU\n*END STEP"
}
