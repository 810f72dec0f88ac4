#!/bin/sh
# Runs a broken deck and compares what is said with expect.txt.
#    run_case.sh ATRITO CASE_FOLDER WORK_FOLDER
# expect.txt: `exit N`; `errors N`, how many in all; `place LINE:COLUMN`, of an error; `contains TEXT`.
set -u
atrito=$1
case_folder=$2
work=$3
rm -rf "$work"
mkdir -p "$work" && cd "$case_folder" || exit 9
"$atrito" deck.inp -o "$work/tables" >"$work/out" 2>"$work/err"
code=$?
bad=0
complain() {
   echo "$*"
   bad=1
}
[ -n "$(find "$work" "$case_folder" -name "*.tab")" ] && complain "a table was written"
[ -e "$work/tables" ] && complain "an output folder was made"
[ -s "$work/out" ] && complain "standard output is not empty"
while read -r what rest; do
   case $what in
   exit) [ "$code" -eq "$rest" ] || complain "exit $code, expected $rest" ;;
   errors) [ "$(grep -c 'error \[' "$work/err")" -eq "$rest" ] || complain "not $rest errors" ;;
   place) grep -q "^deck.inp:$rest: error \[" "$work/err" || complain "no error at $rest" ;;
   contains) grep -qF -- "$rest" "$work/err" || complain "not said: $rest" ;;
   *) complain "expect.txt: unknown line $what" ;;
   esac
done <expect.txt
# errors come in the order of the deck
sed -n 's/^deck\.inp:\([0-9]*\):[0-9]*: error .*/\1/p' "$work/err" >"$work/lines"
sort -n "$work/lines" | cmp -s - "$work/lines" || complain "the errors are not in the order of the deck"
grep -q '^exit' expect.txt && grep -q '^contains' expect.txt || complain "expect.txt asks for nothing"
[ $bad -eq 0 ] || cat "$work/err"
exit $bad
