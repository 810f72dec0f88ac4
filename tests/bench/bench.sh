#!/bin/sh
# Processor time of whole runs, reading the deck and writing the tables included; nothing is asserted.
#    tests/bench/bench.sh [PROGRAM]      default: build/release/bin/atrito
# Prints per deck of input/ the least, median and greatest of eleven runs [s], user and system together.
set -u
top=$(cd "$(dirname "$0")/../.." && pwd) || exit 9
program=${1:-$top/build/release/bin/atrito}
[ -x "$program" ] || { echo "no program at $program; build it first: cmake --build --preset release" >&2; exit 1; }
work=$(mktemp -d) || exit 9
trap 'rm -rf "$work"' EXIT

# Processor seconds of one run, as the program counts them from the start of its process (the last row of timing.tab).
one_run() {
   "$program" "$1" -o "$work/out" --quiet >/dev/null && awk '!/^#/ { cpu = $3 } END { print cpu }' "$work/out/timing.tab"
}

printf '%-36s %8s %8s %8s\n' 'deck, CPU seconds of a run' least median most
for deck in "$top"/input/*.inp; do
   one_run "$deck" >/dev/null
   for i in 1 2 3 4 5 6 7 8 9 10 11; do one_run "$deck"; done | sort -g |
      awk -v deck="$(basename "$deck")" '{ t[NR] = $1 } END { printf "%-36s %8.4f %8.4f %8.4f\n", deck, t[1], t[6], t[NR] }'
done
