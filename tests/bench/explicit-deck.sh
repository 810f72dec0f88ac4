#!/bin/sh
# Prints the deck of scene P with every node and element on a line of its own instead of *BLOCK, as a preprocessor would write it:
# what reading costs. Numbers, coordinates and results are those of scene-p.sh.
#    tests/bench/explicit-deck.sh N [DIGITS]     elements of side 1/N, N even; N = 446 gives 1e6 dofs and, with 8 digits, 34 MB
# DIGITS of the coordinates: 17 (default) give the same doubles as *BLOCK.
set -eu
n=${1:?"usage: explicit-deck.sh N [DIGITS]"}
digits=${2:-17}
awk -v n="$n" -v digits="$digits" '
   # a at t = 0, b at t = 1, rounded as *BLOCK rounds
   function between(a, b, t) { return (t > 0.5) ? b - (1 - t)*(b - a) : a + t*(b - a) }

   function nodes(nx, ny, x1, x2, y1, y2,   i, j, y) {
      print "*NODE"
      for (j = 0; j <= ny; j++) {
         y = between(y1, y2, j/ny)
         for (i = 0; i <= nx; i++) printf form, ++node, between(x1, x2, i/nx), y
      }
   }

   function elements(set, first, nx, ny,   i, j, k) {
      print "*ELEMENT, TYPE=CPE4, ELSET=" set
      for (j = 0; j < ny; j++)
         for (i = 0; i < nx; i++) {
            k = first + j*(nx + 1) + i
            printf "%d, %d, %d, %d, %d\n", ++element, k, k + 1, k + nx + 2, k + nx + 1
         }
   }

   function elset(name, first, last, step) { printf "*ELSET, ELSET=%s, GENERATE\n%d, %d, %d\n", name, first, last, step }
   function nset(name, first, last) { printf "*NSET, NSET=%s, GENERATE\n%d, %d\n", name, first, last }

   BEGIN {
      form = "%d, %." digits "g, %." digits "g\n"
      nx = 2*n; ny = n; mx = n; my = n/2
      printf "*HEADING\nScene P, elements of 1/%d, each on a line\n", n
      nodes(nx, ny, 0, 2, 0, 1)
      upper = node + 1
      nodes(mx, my, .5, 1.5, 1, 1.5)
      elements("LOWER", 1, nx, ny)
      over = element + 1
      elements("UPPER", upper, mx, my)
      nset("LOWER-BOTTOM", 1, nx + 1)
      nset("UPPER-TOP", node - mx, node)
      elset("LOWER-ROW", over - nx, over - 1, 1)
      elset("UPPER-ROW", over, over + mx - 1, 1)
      print "*SURFACE, NAME=LOWER-TOP\nLOWER-ROW, S3\n*SURFACE, NAME=UPPER-BOTTOM\nUPPER-ROW, S1" }'
# the rest of the scene: all that follows its blocks
"$(dirname "$0")/scene-p.sh" "$n" | sed -n '/^\*MATERIAL/,$p'
