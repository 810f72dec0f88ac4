#!/bin/sh
# Prints docs/verification/stability.md: print-stability.sh ATRITO SCENE_DECK QUAD_REFERENCE RANDOM_DECKS >docs/verification/stability.md
# Works in a fresh folder. About two minutes.
set -u
here=$(CDPATH="" cd -- "$(dirname -- "$0")" && pwd)
work=$(mktemp -d) || exit 2
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 2
sh "$here/compare-with-quad.sh" "$1" "$2" "$3" "$here/cases" >cases.txt
sh "$here/run-random.sh" "$1" "$4" 1 3000 1 4 >random.txt
cat "$here/stability.head"
awk '
   function came(exit_code, outer, solves) {
      if (exit_code != 0) return "exit " exit_code
      return "solved, " outer " outer iterations, " solves " solves" }
   function wanted(x) {
      if (x ~ /^exit/) return "exit " substr(x, 5)
      if (x == "open") return "no contact"
      if (x == "law") return "a solution of the law, or exit 3"
      if (x ~ /^like:/) return "8 digits, iterations as " substr(x, 6)
      if (x ~ /^told:/) return "a warning, and " substr(x, 6) " digits"
      if (x == "none:0") return "no pressure"
      if (x ~ /^none:/) return "pressure below " substr(x, 6)
      return x " digits" }
   /^#/ { next }
   { p = $4; t = $5
     if (p == "-") p = t = ""
     printf "| %s | %s | %s%s | %s | %s |\n", $1, wanted($2), came($3, $6, $7), ($8 == "ok" ? "" : ", **not as expected**"), p, t }' cases.txt
printf '\n## Random decks\n\n3,000 decks of seed 1 (`tests/extremes/random_decks.f90`), every answer checked anew from the tables\n(`check-law.awk`):\n\n'
sed 's/^/    /' random.txt
