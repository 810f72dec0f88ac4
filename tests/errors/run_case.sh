#!/bin/sh
# Runs a case of a catalogue of broken decks and compares what is said with what is expected (README.md).
#    run_case.sh ATRITO CATALOGUE CASE WORK_FOLDER
set -u
atrito=$1
catalogue=$2
name=$3
work=$4
folder=$(dirname "$catalogue")
rm -rf "$work"
mkdir -p "$work/deck" || exit 9
awk -v wanted="$name" -v folder="$folder" -v deck="$work/deck/deck.inp" -f "$(dirname "$0")/deck_of_case.awk" \
   "$catalogue" >"$work/expect" || exit 9
cd "$work/deck" || exit 9
"$atrito" deck.inp -o "$work/tables" >"$work/out" 2>"$work/err"
code=$?
bad=0
complain() {
   echo "$*"
   bad=1
}
[ -n "$(find "$work" -name "*.tab")" ] && complain "a table was written"
[ -e "$work/tables" ] && complain "an output folder was made"
[ -s "$work/out" ] && complain "standard output is not empty"
while read -r what rest; do
   case $what in
   exit) [ "$code" -eq "$rest" ] || complain "exit $code, expected $rest" ;;
   errors) [ "$(grep -c 'error \[' "$work/err")" -eq "$rest" ] || complain "not $rest errors" ;;
   place) grep -q "^deck.inp:$rest: error \[" "$work/err" || complain "no error at $rest" ;;
   contains) grep -qF -- "$rest" "$work/err" || complain "not said: $rest" ;;
   *) complain "$catalogue, $name: unknown line $what" ;;
   esac
done <"$work/expect"
# errors come in the order of the deck
sed -n 's/^deck\.inp:\([0-9]*\):[0-9]*: error .*/\1/p' "$work/err" >"$work/lines"
sort -n "$work/lines" | cmp -s - "$work/lines" || complain "the errors are not in the order of the deck"
grep -q '^exit' "$work/expect" && grep -q '^contains' "$work/expect" || complain "$catalogue, $name asks for nothing"
[ $bad -eq 0 ] || cat "$work/err"
exit $bad
