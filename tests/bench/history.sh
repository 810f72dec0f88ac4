#!/bin/sh
# What an increment of a history costs beside its contact iteration, recovery and tables: example 3 in a hundred increments. Prints a
# table to be pasted; asserts nothing.
#    tests/bench/history.sh [PROGRAM [LEVELS...]]
# PROGRAM     default: build/release/bin/atrito
# LEVELS      of --refine, default 1 2 3 4
# Processor seconds of one thread, the least of five runs: `run` is the whole process less that of `check`, the others are phases of
# timing.tab; share = run / (iterate + recover + estimate + check + write). `end` prints the end of the step, `all` every increment.
set -u
top=$(CDPATH="" cd -- "$(dirname -- "$0")/../.." && pwd) || exit 9
program=${1:-$top/build/release/bin/atrito}
[ $# -gt 0 ] && shift
[ $# -gt 0 ] || set -- 1 2 3 4
work=$(mktemp -d) || exit 9
trap 'rm -rf "$work"' EXIT
trap 'exit 130' INT TERM
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1

deck=$top/input/ex3-pillar-in-ground.inp
sed 's/^\*STATIC$/*STATIC\n0.01, 1./' "$deck" >"$work/end.inp"
sed 's/^\(\*[A-Z]* PRINT\)$/\1, FREQUENCY=1/' "$work/end.inp" >"$work/all.inp"

# seconds COMMAND...: user and system, by the shell's times.
seconds() {
   (
      "$@" >/dev/null 2>&1
      times
   ) | awk 'NR == 2 { for (i = 1; i <= 2; i++) { split($i, t, "[ms]"); s += 60*t[1] + t[2] } print s }'
}

# best LEVELS DECK FORM: run and phases of the fastest of five.
best() {
   for i in 1 2 3 4 5; do
      run=$(seconds "$program" "$work/$2.inp" --refine "$1" --contact "$3" -o "$work/out" --quiet)
      before=$(seconds "$program" check "$work/$2.inp" --refine "$1")
      awk -v run="$run" -v before="$before" '!/^#/ { t[$1] = $3 }
         END { work = t["iterate"] + t["recover"] + t["estimate"] + t["check"] + t["write"]
               print run - before, t["factor"] + t["assemble"], t["iterate"], t["recover"], t["estimate"] + t["check"], t["write"],
                     (run - before)/work }' "$work/out/timing.tab"
   done | sort -g | head -1
}

printf '%-6s %-4s %-6s %8s %8s %8s %8s %8s %8s %6s %8s\n' levels deck form run factor iterate recover check write share solves
for levels in "$@"; do
   for deck in end all; do
      for form in dense sparse; do
         row=$(best "$levels" "$deck" "$form")
         solves=$(awk '!/^#/ { n++ } END { print n/100 }' "$work/out/iterations.tab")
         # shellcheck disable=SC2086
         printf '%-6s %-4s %-6s %8.3f %8.3f %8.3f %8.3f %8.3f %8.3f %6.2f %8.1f\n' "$levels" "$deck" "$form" $row "$solves"
      done
   done
done
