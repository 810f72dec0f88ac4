#!/bin/sh
# What is printed to be read at a terminal fits into 80 columns: help, check, and the summaries of a run, a sweep and a study.
#    terminal.sh ATRITO FOLDER   (of decks)
set -u
atrito=$1
decks=$2
work=$(mktemp -d) || exit 2
trap 'rm -rf "$work"' EXIT
failures=0

# fits NAME ARGUMENT...: the standard output of a call that ends well; at least three lines of it
fits() {
   name=$1
   shift
   "$atrito" "$@" >"$work/page" 2>"$work/said" || { echo "$name: exit $?"; failures=$((failures + 1)); }
   wide=$(awk 'length($0) > 80' "$work/page")
   if [ -n "$wide" ] || [ "$(wc -l <"$work/page")" -lt 3 ]; then
      printf '%s:\n%s\n' "$name" "$wide"
      failures=$((failures + 1))
   fi
}

fits '--help' --help
fits 'help' help
"$atrito" help | sed -n 's/^  \*\([A-Z][A-Z ]*[A-Z]\)\( +\)\{0,1\}   *[^ ].*/\1/p' >"$work/keywords"
[ "$(wc -l <"$work/keywords")" -gt 30 ] || { echo 'no list of keywords'; failures=1; }
while read -r keyword; do
   # shellcheck disable=SC2086
   fits "help $keyword" help $keyword
done <"$work/keywords"
for deck in "$decks"/*.inp; do
   fits "check ${deck##*/}" check "$deck"
done
deck=$decks/ex1-plate-on-rigid-support.inp
fits 'a run' "$deck" -o "$work/run"
fits 'a sweep' sweep "$deck" --vary delta=1e-2,1e-3 -o "$work/sweep"
fits 'a study' study "$deck" --levels 2 --elements cpe4,cpe9 -o "$work/study"
[ "$failures" -eq 0 ] && echo 'all fit'
[ "$failures" -eq 0 ]
