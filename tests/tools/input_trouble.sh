#!/bin/sh
# Decks that are none, output that nobody takes, memory that is not there: a clear word and the right exit code, at once.
#    input_trouble.sh ATRITO DECK
. "$(dirname "$0")/lib.sh"
atrito=$1
deck=$2

# expect CODE TEXT WHAT [OPTION ...]: runs the program on $work/deck.inp; it has ten seconds and 2 GB
expect() {
   wanted=$1
   text=$2
   what=$3
   shift 3
   (ulimit -v 2000000 && timeout 120 "$atrito" "$work/deck.inp" -o "$work/none" "$@") >"$work/out" 2>"$work/err"
   code=$?
   row "$what" "exit $wanted" "exit $code"
   [ "$code" -eq "$wanted" ] || { fail "$what: exit $code, expected $wanted"; cat "$work/err"; }
   grep -qF -- "$text" "$work/err" || { fail "$what: not said: $text"; cat "$work/err"; }
   grep -q 'untime error\|Backtrace' "$work/err" && fail "$what: the run-time library complains"
   [ -e "$work/none" ] && fail "$what: an output folder was made"
   rm -rf "$work/deck.inp" "$work/none"
}

mkdir "$work/deck.inp"
expect 5 "deck.inp: is a folder" 'a folder'
if mkfifo "$work/deck.inp" 2>/dev/null; then
   expect 5 "deck.inp: is a pipe or a terminal" 'a pipe without a writer'
fi
if dd if=/dev/zero of="$work/deck.inp" bs=1 count=0 seek=2200000000 2>/dev/null; then
   expect 5 "deck.inp: is larger than 2 GB" 'a file of 2.2 GB'
   dd if=/dev/zero of="$work/deck.inp" bs=1 count=0 seek=1900000000 2>/dev/null
   expect 2 "[E-BINARY]" 'a file of 1.9 GB of zeros'
fi
cp "$atrito" "$work/deck.inp"
expect 2 "[E-BINARY]" 'a program'
: >"$work/deck.inp"
expect 2 "[E-EMPTY]" 'an empty file'
printf '\n\n  \n' >"$work/deck.inp"
expect 2 "[E-EMPTY]" 'a blank file'
if [ "$(id -u)" -ne 0 ]; then # root reads what others may not
   cp "$deck" "$work/deck.inp"
   chmod a-r "$work/deck.inp"
   expect 5 "deck.inp: cannot be read" 'an unreadable file'
fi
printf '*INCLUDE, INPUT=../%s/deck.inp\n*INCLUDE, INPUT=../%s/deck.inp\n' "${work##*/}" "${work##*/}" >"$work/deck.inp"
expect 2 "in a circle" 'a circle under other names'
for i in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16; do
   printf '*INCLUDE, INPUT=d%s\n*INCLUDE, INPUT=d%s\n' "$i" "$i" >"$work/d$((i - 1))"
done
: >"$work/d16"
cp "$work/d0" "$work/deck.inp"
expect 2 "includes of more than 10000 files" 'includes without number'
# 150 MB of commas: 15 GB of items; the limit of expect is 2 GB
printf '*NODE\n' >"$work/deck.inp"
dd if=/dev/zero bs=1000000 count=150 2>/dev/null | tr '\0' ',' >>"$work/deck.inp"
expect 2 "[E-MEMORY]" 'more items than fit into memory'

# a scene of CARDS instead of the deck's mesh
scene() {
   printf '%s\n' "$@" '*MATERIAL, NAME=M' '*ELASTIC' '1, 0.3' '*SOLID SECTION, ELSET=B, MATERIAL=M' '1' '*STEP' '*STATIC' \
      '*END STEP' >"$work/deck.inp"
}
block() { # block TYPE NX NY
   scene "*BLOCK, TYPE=$1, ELSET=B, NX=$2, NY=$3" '0, 0' '1, 0' '1, 1' '0, 1' '*BOUNDARY' 'B-BOTTOM, 1, 2'
}
block CPE4 100000 100000
expect 2 "a block of more than 50000000 nodes" 'a block of 1e10 elements'
block CPE9 2147483647 1
expect 2 "a block of more than 50000000 nodes" 'a block whose count leaves the integers'
block CPE4 7000 7000
expect 2 "[E-MEMORY] a mesh of 49014001 nodes and 49000000 elements needs about" 'a block of 49 million elements'
block CPE4 600 600
expect 2 "[E-MEMORY] the scene, 721200 free displacements and 0 contact unknowns, needs about" 'a matrix of 9 GB' --solver banded
scene '*NODE' '1, 0, 0' '40000001, 1, 0' '*NGEN' '1, 40000001' '*NGEN' '1, 40000001, 2'
expect 2 "[E-MEMORY] a mesh of 40000002 nodes" '40 million generated nodes'
scene '*NODE' '1, 0, 0' '2, 1, 0' '3, 1, 1' '4, 0, 1' '*ELEMENT, TYPE=CPE4, ELSET=B' '1, 1, 2, 3, 4' '*ELGEN, ELSET=B' \
   '1, 2000000000, 0, 1'
expect 2 "[E-MEMORY] a mesh of 4 nodes and 2000000001 elements" '2e9 copies of an element'

# the reader of the output goes away, or there is none: the tables are what counts
"$atrito" "$deck" --quiet -o "$work/whole" || fail 'the deck itself fails'
same() { # same WHAT: the tables of the run without a reader
   row "$1" 'exit 0' "exit $code"
   [ "$code" -eq 0 ] || fail "$1: exit $code, expected 0"
   "$atrito" compare "$work/whole" "$work/run" --rtol 0 >"$work/out" || { fail "$1: other tables"; cat "$work/out"; }
   for table in nodes contact reactions stress; do
      cmp -s "$work/whole/$table.tab" "$work/run/$table.tab" || fail "$1: another $table.tab"
   done
   rm -rf "$work/run"
}
"$atrito" "$deck" -o "$work/run" 2>/dev/null >&-
code=$?
same 'closed standard output'
"$atrito" "$deck" -o "$work/run" >&- 2>&-
code=$?
same 'closed standard output and error'
{ "$atrito" "$deck" -o "$work/run" 2>&1; echo $? >"$work/code"; } | :
code=$(cat "$work/code")
same 'a pipe that nobody reads'
if [ -w /dev/full ]; then
   "$atrito" "$deck" -o "$work/run" >/dev/full 2>/dev/full
   code=$?
   same 'a full disk behind standard output'
fi

finish
