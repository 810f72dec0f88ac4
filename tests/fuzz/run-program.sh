#!/bin/sh
# Runs the whole program on mutated decks, a process each: no crash, no hang, an exit code that means something, and nothing left
# behind.
#    run-program.sh [-n COUNT] [-s SEED] [-k FIRST] ATRITO ATRITO_FUZZ DECK...
# A mutation that fails is told with its number: atrito_fuzz --seed SEED --one NUMBER --write FILE DECK... makes its deck again.
set -u
count=60
seed=5
first=1
while getopts n:s:k: option; do
   case $option in
   n) count=$OPTARG ;;
   s) seed=$OPTARG ;;
   k) first=$OPTARG ;;
   *) exit 9 ;;
   esac
done
shift $((OPTIND - 1))
atrito=$(readlink -f -- "$1") || exit 9
fuzz=$(readlink -f -- "$2") || exit 9
shift 2
work=$(mktemp -d) || exit 9
trap 'rm -rf "$work"' EXIT
failures=0
complain() {
   failures=$((failures + 1))
   echo "FAILED: --seed $seed --one $k: $*"
   sed 's/^/   /' "$work/err" | tail -n 5
}
n0=0 n2=0 n3=0 n4=0
"$fuzz" --seed "$seed" --first "$first" --count "$count" --keep --write "$work/deck" "$@" >"$work/made" 2>&1 || {
   cat "$work/made"
   exit 1
}
k=$first
while [ "$k" -lt $((first + count)) ]; do
   mkdir "$work/run"
   mv "$work/deck.$k" "$work/run/fuzz-deck.inp"
   [ -e "$work/deck.$k.msh" ] && mv "$work/deck.$k.msh" "$work/run/fuzz-deck.inp.msh"
   (cd "$work/run" && ulimit -v 4000000 && timeout 20 "$atrito" fuzz-deck.inp -o tables) >"$work/out" 2>"$work/err"
   code=$?
   case $code in
   0) n0=$((n0 + 1)) ;;
   2) n2=$((n2 + 1)) ;;
   3) n3=$((n3 + 1)) ;;
   4) n4=$((n4 + 1)) ;;
   *) complain "exit code $code" ;;
   esac
   left=$(find "$work/run" -type f ! -name 'fuzz-deck.inp*' | wc -l)
   case $code in
   0 | 3)
      [ -s "$work/run/tables/summary.tab" ] || complain "exit code $code without tables"
      find "$work/run" -name '*.part' | grep -q . && complain "a temporary file is left"
      for table in "$work/run/tables"/nodes.tab "$work/run/tables"/stress.tab; do
         [ "$code" -eq 0 ] && [ -e "$table" ] && grep -v '^#' "$table" | grep -qi 'nan\|inf' &&
            complain "exit code 0, and a result that is no number"
      done
      ;;
   *)
      [ "$left" -eq 0 ] || complain "exit code $code, and files are left"
      [ -e "$work/run/tables" ] && complain "exit code $code, and a folder is left"
      ;;
   esac
   errors=$(grep -c 'error \[' "$work/err")
   [ "$code" -eq 2 ] && [ "$errors" -eq 0 ] && complain "exit code 2 and no error"
   [ "$code" -eq 0 ] && [ "$errors" -ne 0 ] && complain "exit code 0 and an error"
   grep -q 'untime error\|Backtrace\|internal error' "$work/err" && complain "the run-time library complains"
   rm -rf "$work/run"
   k=$((k + 1))
done
echo "seed $seed, mutations $first to $((k - 1)): $n0 solved, $n2 with errors, $n3 not converged, $n4 singular; $failures failures"
[ "$failures" -eq 0 ]
