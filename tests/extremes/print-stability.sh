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
# a row for each property: how many scenes, what came, the fewest digits; then those of which fewer than eight digits are asked
awk '
   function row(pattern, title) { patterns[++kinds] = pattern; titles[kinds] = title }
   function count(k, what) { if (!((k, what) in n)) kept[k] = kept[k] (kept[k] == "" ? "" : "|") what; n[k, what]++ }
   function least(list, k, value) { if (value != "-" && (!(k in list) || value + 0 < list[k])) list[k] = value + 0 }
   function digits(list, k) { return (k in list) ? sprintf("%.1f", list[k]) : "" }
   BEGIN {
      row("-E-ratio", "E of the lower body over that of the upper one: 1e-12 to 1e12")
      row("-delta-E/h", "penalty, delta E/h: 0, 1e-20 to 1e2")
      row("-nu-[0-9]", "nu: 0, 1e-8, 3 to 1e6")
      row("-rho-", "rho: 0, a hundredth of an element, ten contact lines")
      row("^(one|symmetry|matching)", "one element in contact, or in a body; points held by symmetry")
      row("-(load|move)(-[0-9]|$)", "loads and movements: 0, 1e-300 to 1e300")
      row("-eps-(over|[0-9])", "eps over the largest slip: 0, 1e-300 to 1e2")
      row("(open|lifted)", "sides that part")
      row("grazing", "sides that just touch")
      row("interference", "sides that overlap")
      row("(fine|coarse)-on", "fine slaves on coarse masters and the other way round, hard and soft")
      row("^(aspect|slender)", "elements 1e6 times as long as wide; a column of 200 elements")
      row("^(at-|moved|flat-at)", "up to 1e8 lengths from the origin")
      row("^unit", "m and kN, mm and N, Gm and kN, um and N")
      row("", "a block on a slope: slides, holds") }
   /^#/ { next }
   {
      for (k = 1; $1 !~ patterns[k]; k++) { }
      scenes[k]++
      count(k, $3 == 0 ? "solved" : "exit " $3)
      least(p, k, $4); least(t, k, $5)
      if ($6 > outer[k]) outer[k] = $6
      if ($7 > solves[k]) solves[k] = $7
      if ($8 != "ok") odd = odd "| **" $1 "** | " $2 " | **not as expected** | " $4 ", " $5 " |\n"
      asked = $2; sub("told:", "", asked)
      if (asked ~ /^[0-9.]+$/ && asked < 8) odd = odd "| " $1 " | " asked (asked == $2 ? "" : ", and a warning") " | " $4 " | " $5 " |\n" }
   END {
      print "| property | scenes | outcome | fewest digits of p | of t | most outer iterations | most solves |\n|---|---|---|---|---|---|---|"
      for (k = 1; k <= kinds; k++) {
         m = split(kept[k], what, "|"); text = ""
         for (i = 1; i <= m; i++) text = text (i > 1 ? ", " : "") n[k, what[i]] " " what[i]
         printf "| %s | %d | %s | %s | %s | %d | %d |\n", titles[k], scenes[k], text, digits(p, k), digits(t, k), outer[k], solves[k] }
      printf "\n| scenes with fewer than eight digits required | digits | of p | of t |\n|---|---|---|---|\n%s", odd }' cases.txt
# measures CASE: a row of what a case of tests/verify asserts: how many numbers, the largest error as a share of what is allowed, and where
measures() {
   mkdir -p "$1"
   (cd "$1" && sh "$tests/verify/$1/check.sh" "$atrito" "$tests/verify/$1" "$tests/../input" "$build/tests/tools/error_norms" >../"$1.txt" 2>&1)
   awk -v name="$1" '
      function take(what, off,   part, share) {
         sub(/[:,].*/, "", what)
         split(off, part, " of ")
         n++
         share = part[2] > 0 ? part[1]/part[2] : (part[1] > 0 ? 1e300 : 0)
         if (share > worst) { worst = share; where = what } }
      /, off by .* of / { off = $0; sub(/.*, off by /, "", off); take($0, off); next }
      /worst difference .* of / { off = $0; sub(/.*worst difference /, "", off); take($0, off) }
      /^FAILED/ { failed = failed "| **" $0 "** | | | |\n" }
      END { printf "| %s | %d | %.2g | %s |\n%s", name, n, worst, where, failed }' "$1.txt"
}
cat <<'END'

## Slender elements, far places, units; several solutions, or none

Cases of `tests/verify`, whose READMEs give the tolerances with reasons: bars, patches and beams with elements up to 1e6 times as long as wide and 1e8 lengths from the origin (`extreme-geometry`); one scene in
six systems of units; one node whose friction has three solutions, or whose plain Picard loop alternates (`several-solutions`); a block held by friction alone, or not; bodies that are free to move; loops that do not
converge. Exit codes (3, 4) and messages are asserted, too.

| case | numbers | largest error over the allowed one | of |
|---|---|---|---|
END
for case in extreme-geometry units several-solutions friction-holds free-motion not-converged; do measures $case; done
printf '\n## Faults\n\nBroken input, files that cannot be read or written, signals (tests/tools). After each the scripts also check that no temporary\n'
printf 'file is left and that the results of an earlier run are unchanged. Outcomes are as expected unless bold.\n\n| outcome | after |\n|---|---|\n'
FAULT_ROWS=$work/rows
export FAULT_ROWS
: >"$FAULT_ROWS"
deck=$tests/../input/ex1-plate-on-rigid-support.inp
for script in input_trouble file_trouble renaming; do sh "$tests/tools/$script.sh" "$atrito" "$deck" >said.txt 2>&1 || echo "| **$script** | | failed |" >>"$FAULT_ROWS"; done
sh "$tests/tools/interrupts.sh" "$atrito" "$build/tests/tools/interrupt_probe" "$tests/../input/ex3-pillar-in-ground.inp" >said.txt 2>&1 ||
   echo '| **interrupts** | | failed |' >>"$FAULT_ROWS"
sh "$tests/tools/two_runs.sh" "$atrito" "$deck" >said.txt 2>&1 || cat said.txt >&2
awk -F ' *[|] *' '
   { came = $3 == $4 ? $4 : "**" $4 "**, not " $3
     sub(/[, ]*$/, "", $2)
     if (!(came in faults)) order[++n] = came
     else if (index("; " faults[came] ";", "; " $2 ";")) next
     faults[came] = faults[came] (faults[came] == "" ? "" : "; ") $2 }
   END { for (i = 1; i <= n; i++) print "| " order[i] " | " faults[order[i]] " |" }' "$FAULT_ROWS"
printf '\nMutated decks: [fuzzing.md](fuzzing.md).\n'
printf '\n## Random decks\n\n3,000 decks of seed 1 (`tests/extremes/random_decks.f90`), every answer checked anew from the tables\n(`check-law.awk`):\n\n'
sed 's/^/    /' random.txt
cat "$here/scenes.head"
# SCENE_SEEDS: which seeds of random scenes to run, too; SCENES: how many of each
python=python3
[ -x "$tests/../build/venv/bin/python3" ] && python=$tests/../build/venv/bin/python3
for seed in ${SCENE_SEEDS:-}; do
   "$python" "$here/run_scenes.py" "$atrito" "$build/tests/extremes/random_scenes" 1 "${SCENES:-5000}" "$seed" >scenes.txt 2>&1
   printf '\nSeed %s:\n\n' "$seed"
   tail -n 2 scenes.txt | sed 's/^/    /; s/; [0-9]* s, the program.*//'
done
