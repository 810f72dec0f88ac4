#!/bin/sh
# Prints docs/verification/stability.md from the programs of a build folder:
#    print-stability.sh BUILD >docs/verification/stability.md
# Works in a fresh folder. About three minutes.
set -u
here=$(CDPATH="" cd -- "$(dirname -- "$0")" && pwd)
tests=${here%/*}
build=$(CDPATH="" cd -- "$1" && pwd) || exit 2
atrito=$build/bin/atrito
work=$(mktemp -d) || exit 2
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 2
set -- "$atrito" "$build/tests/extremes/scene_deck" "$build/tests/tools/quad_reference/quad_reference" \
   "$build/tests/extremes/random_decks"
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
# measures CASE: what a case of tests/verify asserts, a row a scene: how many numbers, the largest error as a share of what is allowed
measures() {
   mkdir -p "$1"
   (cd "$1" && sh "$tests/verify/$1/check.sh" "$atrito" "$tests/verify/$1" "$tests/../input" "$build/tests/tools/error_norms" >../"$1.txt" 2>&1)
   awk '
      function take(what, off,   part) {
         sub(/[:,].*/, "", what)
         split(off, part, " of ")
         if (!(what in n)) order[++scenes] = what
         n[what]++
         share = part[2] > 0 ? part[1]/part[2] : (part[1] > 0 ? 1e300 : 0)
         if (share > worst[what]) worst[what] = share }
      /, off by .* of / { off = $0; sub(/.*, off by /, "", off); take($0, off); next }
      /worst difference .* of / { off = $0; sub(/.*worst difference /, "", off); take($0, off) }
      /^FAILED/ { failed = failed "| **" $0 "** | | |\n" }
      END { for (i = 1; i <= scenes; i++) printf "| %s | %d | %.2g |\n", order[i], n[order[i]], worst[order[i]]; printf "%s", failed }' "$1.txt"
}
printf '\n## Poisson'"'"'s ratio\n\nLame'"'"'s ring in plane strain (tests/verify/locking), 384 elements: relative error of the displacements. BBAR is\n'
printf '`*SOLID SECTION, FORMULATION=BBAR`. More, Cook'"'"'s membrane and contact pressures: [locking.md](locking.md).\n\n'
printf '| mu | CPE4 | BBAR | CPE9 | the program says |\n|---|---|---|---|---|\n'
measures locking >locking.rows
for mu in -0.9 0 0.3 0.49 0.4999 0.4999999; do
   for kind in CPE4 BBAR CPE9; do
      awk -v name=${kind}_$mu '$1 == name { e = $4 } END { printf "%.2e ", e }' locking/ring.txt
   done >errors
   said=
   grep -q W-LOCKING locking/ring-CPE4_$mu-16.err && said='W-LOCKING without BBAR'
   echo "$mu $(cat errors) $said" | awk '{ printf "| %s | %s | %s | %s |", $1, $2, $3, $4; for (i = 5; i <= NF; i++) printf " %s", $i; print " |" }'
done
echo '| 0.5, -1, above 0.5 | | | | exit 2 (tests/errors) |'
grep FAILED locking.rows
printf '\n## Slender elements, far places, units\n\nAgainst closed forms, or the same scene in other units (tests/verify/extreme-geometry, units; their READMEs tell what is allowed\nand why). `bar-CPS4-1e6-1`: elements 1e6 times as long as wide; the last number of a bar is how far it was moved.\n\n| scene | numbers | largest error over the allowed one |\n|---|---|---|\n'
measures extreme-geometry
measures units
printf '\n## Several solutions, or none\n\nOne node whose friction has three solutions, or whose plain Picard loop goes to and fro (tests/verify/several-solutions); a\n'
printf 'block held by friction alone, or not (friction-holds); bodies that are free to move (free-motion); loops that do not\n'
printf 'converge (not-converged). `all hold`: the exit codes (3, 4) and the words are as expected, too.\n\n'
printf '| scene | numbers | largest error over the allowed one |\n|---|---|---|\n'
for case in several-solutions friction-holds free-motion not-converged; do
   measures $case
   echo "| tests/verify/$case | | $(tail -1 $case.txt) |"
done
printf '\n## Faults\n\nBroken input, files that cannot be read or written, signals (tests/tools). After each the scripts also look that no temporary\n'
printf 'file is left and that the results of an earlier run are what they were.\n\n| fault | expected | came |\n|---|---|---|\n'
FAULT_ROWS=$work/rows
export FAULT_ROWS
: >"$FAULT_ROWS"
deck=$tests/../input/ex1-plate-on-rigid-support.inp
for script in input_trouble file_trouble renaming; do sh "$tests/tools/$script.sh" "$atrito" "$deck" >said.txt 2>&1 || echo "| **$script** | | failed |" >>"$FAULT_ROWS"; done
sh "$tests/tools/interrupts.sh" "$atrito" "$build/tests/tools/interrupt_probe" "$tests/../input/ex3-pillar-in-ground.inp" >said.txt 2>&1 ||
   echo '| **interrupts** | | failed |' >>"$FAULT_ROWS"
sh "$tests/tools/two_runs.sh" "$atrito" "$deck" >said.txt 2>&1 || cat said.txt >&2
cat "$FAULT_ROWS"
printf '\nMutated decks: [fuzzing.md](fuzzing.md).\n'
printf '\n## Random decks\n\n3,000 decks of seed 1 (`tests/extremes/random_decks.f90`), every answer checked anew from the tables\n(`check-law.awk`):\n\n'
sed 's/^/    /' random.txt
cat "$here/scenes.head"
# SCENE_SEEDS: which seeds; SCENES: how many of each
python=python3
[ -x "$tests/../build/venv/bin/python3" ] && python=$tests/../build/venv/bin/python3
for seed in ${SCENE_SEEDS:-11}; do
   "$python" "$here/run_scenes.py" "$atrito" "$build/tests/extremes/random_scenes" 1 "${SCENES:-5000}" "$seed" >scenes.txt 2>&1
   printf '\nSeed %s:\n\n' "$seed"
   tail -n 2 scenes.txt | sed 's/^/    /; s/; [0-9]* s, the program.*//'
done
