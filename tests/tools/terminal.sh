#!/bin/sh
# What is printed to be read at a terminal fits into 80 columns: help, check, and the summaries of a run, a sweep and a study.
#    terminal.sh ATRITO FOLDER   (of decks)
. "$(dirname "$0")/lib.sh"
atrito=$1
decks=$2

# fits NAME ARGUMENT...: the standard output of a call that ends well; at least three lines of it
fits() {
   name=$1
   shift
   "$atrito" "$@" >"$work/page" 2>"$work/said" || fail "$name: exit $?"
   wide=$(awk 'length($0) > 80' "$work/page")
   if [ -n "$wide" ] || [ "$(wc -l <"$work/page")" -lt 3 ]; then
      fail "$name:"
      echo "$wide"
   fi
}

fits '--help' --help
fits 'help' help
"$atrito" help | sed -n 's/^  \*\([A-Z][A-Z ]*[A-Z]\)\( +\)\{0,1\}   *[^ ].*/\1/p' >"$work/keywords"
[ "$(wc -l <"$work/keywords")" -gt 30 ] || fail 'no list of keywords'
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
finish
