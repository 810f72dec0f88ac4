#!/bin/sh
# Files that cannot be written: exit 5, the file is named, and nothing of an earlier run is replaced.
#    file_trouble.sh ATRITO DECK
set -u
atrito=$1
deck=$2
work=$(mktemp -d) || exit 2
trap 'rm -rf "$work"' EXIT
failures=0

fail() {
   echo "$1"
   failures=$((failures + 1))
}

expect_5() { # expect_5 WHAT NAME: the outcome of the last run
   [ "$code" -eq 5 ] || fail "$1: exit $code, expected 5"
   grep -q "$2" "$work/said" || { fail "$1: $2 is not named"; cat "$work/said"; }
}

untouched() { # untouched WHAT: the folder is as the first run left it
   ls -A "$work/out" | grep -q '\.part$' && fail "$1: a temporary file is left"
   for file in "$work/before"/*; do
      cmp -s "$file" "$work/out/${file##*/}" || fail "$1: ${file##*/} was replaced"
   done
}

"$atrito" "$deck" --quiet -o "$work/out" || { echo 'the deck itself fails'; exit 1; }
cp -r "$work/out" "$work/before"

# a limit on the size of files comes as a full disk does
(ulimit -f 1; "$atrito" "$deck" --quiet --digits 17 -o "$work/out") >"$work/said" 2>&1
code=$?
expect_5 'a full disk' "$work/out/"
untouched 'a full disk'

(ulimit -f 1; "$atrito" "$deck" --quiet -o "$work/new") >"$work/said" 2>&1
code=$?
expect_5 'a full disk, new folder' "$work/new/"
[ -e "$work/new" ] && fail 'a full disk: the new folder is left'

rm "$work/out/timing.tab" "$work/before/timing.tab"
mkdir "$work/out/timing.tab"
"$atrito" "$deck" --quiet --digits 17 -o "$work/out" >"$work/said" 2>&1
code=$?
expect_5 'a folder in the place of a table' "$work/out/timing.tab"
untouched 'a folder in the place of a table'

"$atrito" "$deck" --quiet -o "$work/before/summary.tab" >"$work/said" 2>&1
code=$?
expect_5 'a file in the place of the folder' "$work/before/summary.tab"

if [ "$(id -u)" -ne 0 ]; then # root writes where others may not
   chmod a-w "$work/out"
   "$atrito" "$deck" --quiet --digits 17 -o "$work/out" >"$work/said" 2>&1
   code=$?
   chmod u+w "$work/out"
   expect_5 'a read-only folder' "$work/out/"
   untouched 'a read-only folder'
fi

"$atrito" "$work/nowhere.inp" --quiet -o "$work/none" >"$work/said" 2>&1
code=$?
expect_5 'a deck that is not there' "$work/nowhere.inp"
[ -e "$work/none" ] && fail 'a deck that is not there: a folder was made'

[ "$failures" -eq 0 ] && echo 'all as expected'
[ "$failures" -eq 0 ]
