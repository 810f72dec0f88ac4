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

# At a terminal (of script, util-linux) progress is one line that is gone in the end; elsewhere it has a line a phase.
cp "$deck" "$work/deck.inp"
cd "$work" || exit 9
"$atrito" deck.inp -o run >said 2>told
printf 'read  deck.inp\nsolve\nwrite run\n' | cmp -s - told || { fail 'progress, no terminal:'; cat told; }
"$atrito" deck.inp -o run --progress all >said 2>told
grep -q '^outer 1  solves ' told || fail 'progress of iterations is not told'
grep -q '^bound of the error$' told || fail 'progress does not tell of the bound'
if command -v script >/dev/null; then
   mkdir bin
   printf '#!/bin/sh\n[ -e slept ] || sleep 1.2\n: >slept\n' >bin/gnuplot      # the first waits long enough for the line
   chmod +x bin/gnuplot
   # shell COMMAND: what a terminal of 50 columns gets of it
   shell() {
      TERM=xterm NO_COLOR=1 PATH=$work/bin:$PATH script -qec "stty cols 50; $1" /dev/null </dev/null | tr -d '\r' >shown
   }
   shell "$atrito deck.inp -o run --plot --plot-box 0,0,1,1"
   tr -d '\033' <shown | grep -Eq '\[K\[ *[0-9]+ s\] plot  run/plots\[K' || { fail 'no line of progress'; cat -v shown; }
   sed "s/.*\[K//" shown >left
   grep -q '^read \|^\[ *[0-9]' left && fail 'progress is left on the screen'
   sed "s/, NSET/, NSTE/; s/SUPPORT$/SUPORT/" deck.inp >wrong.inp
   shell "$atrito wrong.inp -o run"
   grep -q N-OLDER shown || { fail 'the older results'; cat shown; }
   tail -n 1 shown | grep -q 'in the deck$' || fail 'the errors do not come last'
   [ -z "$(awk 'length($0) > 50' shown)" ] || { fail 'messages are wider than the terminal'; cat shown; }
fi
finish
