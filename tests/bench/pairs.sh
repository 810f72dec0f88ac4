#!/bin/sh
# What the search and the segments of a pair cost: `check` of n faces on 2n/3 with nodes that do not match (MORTAR) less `check` of the
# same blocks without the pair, on straight sides and on circles. Prints a table to be pasted; asserts nothing.
#    tests/bench/pairs.sh [PROGRAM [FACES...]]
# PROGRAM     default: build/release/bin/atrito
# FACES       of the slave, default 1000 10000 100000
# Seconds: processor time, user and system; the least of five runs of either deck, one after the other, in turns.
set -u
top=$(CDPATH="" cd -- "$(dirname -- "$0")/../.." && pwd) || exit 9
program=${1:-$top/build/release/bin/atrito}
[ $# -gt 0 ] && shift
[ $# -gt 0 ] || set -- 1000 10000 100000
work=$(mktemp -d) || exit 9
trap 'rm -rf "$work"' EXIT
trap 'exit 130' INT TERM

# deck KIND FACES PAIR: two strips of one row of squares.
deck() {
   awk -v kind="$1" -v n="$2" -v pair="$3" '
      function place(s, y,   r) {
         if (kind == "straight") return sprintf("%.17g, %.17g", s, y)
         r = n/5 - y                                   # an arc of five radians
         return sprintf("%.17g, %.17g", r*sin(s*5/n), -r*cos(s*5/n))
      }
      function strip(name, m, y,   i, j) {
         print "*NODE"
         for (j = 0; j < 2; j++) for (i = 0; i <= m; i++) print nodes + j*(m + 1) + i + 1 ", " place(i*n/m, y + j)
         print "*ELEMENT, TYPE=CPE4, ELSET=" name
         for (i = 1; i <= m; i++)
            print cells + i ", " nodes + i ", " nodes + i + 1 ", " nodes + m + i + 2 ", " nodes + m + i + 1
         nodes += 2*(m + 1); cells += m
         print "*SURFACE, NAME=" name "-BELOW\n" name ", S1\n*SURFACE, NAME=" name "-ABOVE\n" name ", S3"
      }
      BEGIN {
         print "*HEADING\n" n " faces"
         strip("LOW", int(2*n/3), 0); strip("UP", n, 1)
         print "*MATERIAL, NAME=M\n*ELASTIC\n1000, 0.3\n*SOLID SECTION, ELSET=LOW, MATERIAL=M\n*SOLID SECTION, ELSET=UP, MATERIAL=M"
         print "*SURFACE INTERACTION, NAME=I"
         if (pair) print "*CONTACT PAIR, INTERACTION=I\nUP-BELOW, LOW-ABOVE"
         print "*BOUNDARY\n1, 1, 2\n2, 1, 2\n" nodes ", 1, 2\n" nodes - 1 ", 1, 2\n*STEP\n*STATIC\n*END STEP"
      }' </dev/null >"$work/$1-$3.inp"
}

# seconds DECK: of the processor, of one check.
seconds() {
   sh -c 'n=0; "$1" check "$2" >/dev/null 2>&1 || exit 9; times' sh "$program" "$work/$1.inp" |
      awk 'NR == 2 { for (i = 1; i <= 2; i++) { split($i, t, "[ms]"); sum += 60*t[1] + t[2] } print sum }'
}

echo '| faces | on | sides | without the pair [s] | with it [s] | of the pair [s] | of a face [us] |'
echo '|---|---|---|---|---|---|---|'
for kind in straight round; do
   for faces; do
      deck $kind "$faces" 0
      deck $kind "$faces" 1
      for i in 1 2 3 4 5; do echo "$(seconds $kind-0) $(seconds $kind-1)"; done |
         awk -v n="$faces" -v kind=$kind '{ if (NR == 1 || $1 < a) a = $1; if (NR == 1 || $2 < b) b = $2 }
            END { printf "| %d | %d | %s | %.3f | %.3f | %.3f | %.2f |\n", n, 2*n/3, kind, a, b, b - a, 1e6*(b - a)/n }'
   done
done
