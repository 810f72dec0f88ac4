#!/bin/sh
# Files that cannot be written: exit 5, the file is named, and nothing of an earlier run is replaced.
#    file_trouble.sh ATRITO DECK
. "$(dirname "$0")/lib.sh"
atrito=$1
deck=$2

expect_5() { # expect_5 WHAT NAME: the outcome of the last run
   row "$1" 'exit 5' "exit $code"
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

rmdir "$work/out/timing.tab"
cp "$work/before/summary.tab" "$work/out/timing.tab"
cp "$work/before/summary.tab" "$work/before/timing.tab"
# folders that cannot be made: links that lead nowhere, a name that is too long, alone and in a folder that is new
ln -s nowhere "$work/link"
long=$(printf 'n%.0s' 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29 30)
long=$long$long$long$long$long$long$long$long$long$long
for folder in link link/new "$long" "new/$long" "new/newer/$long/last"; do
   "$atrito" "$deck" -o "$work/$folder" >"$work/said" 2>&1
   code=$?
   expect_5 "a folder that cannot be made, ${folder%"$long"*}" "$work/${folder%%/*}"
   grep -q '^factor' "$work/said" && fail "a folder that cannot be made, ${folder%"$long"*}: told after the work"
   [ -e "$work/new" ] && fail 'a folder that cannot be made: those above it are left'
done
for folder in summary.tab summary.tab/new; do
   "$atrito" "$deck" -o "$work/before/$folder" >"$work/said" 2>&1
   code=$?
   expect_5 'a file in the place of the folder' "$work/before/summary.tab: is no folder"
   grep -q '^factor' "$work/said" && fail 'a file in the place of the folder: told after the work'
done
"$atrito" sweep "$deck" -o "$work/before/summary.tab" --vary nu=0.1,0.2 >"$work/said" 2>&1
code=$?
expect_5 'a sweep into a file' "$work/before/summary.tab: is no folder"

# what needs a user whom permissions stop: root writes where others may not, and lends its rights away where it can
as_user() {
   "$@"
}
may_test=yes
if [ "$(id -u)" -eq 0 ]; then
   may_test=no
   if command -v setpriv >/dev/null && setpriv --reuid 65534 --clear-groups true 2>/dev/null; then
      chmod 755 "$work"
      as_user() {
         setpriv --reuid 65534 --clear-groups "$@"
      }
      as_user test -r "$deck" && as_user test -x "$atrito" && may_test=yes
      chown -R 65534 "$work/out"
   fi
fi
if [ $may_test = yes ]; then
   chmod a-w "$work/out"
   for task in '' 'sweep --vary nu=0.1,0.2'; do
      as_user "$atrito" $task "$deck" --digits 17 -o "$work/out" >"$work/said" 2>&1
      code=$?
      expect_5 "a read-only folder, $task" "$work/out: the folder cannot be written into"
      grep -q '^factor' "$work/said" && fail 'a read-only folder: told after the work'
   done
   as_user "$atrito" "$deck" -o "$work/out/new/er" >"$work/said" 2>&1
   code=$?
   expect_5 'a new folder in a read-only one' "$work/out: the folder cannot be written into"
   chmod u+w "$work/out"
   untouched 'a read-only folder'

   # a table that its owner has protected stays, and so do the others
   chmod a-w "$work/out/nodes.tab"
   as_user "$atrito" "$deck" --quiet --digits 17 -o "$work/out" >"$work/said" 2>&1
   code=$?
   chmod u+w "$work/out/nodes.tab"
   expect_5 'a write-protected table' "$work/out/nodes.tab: is write-protected"
   untouched 'a write-protected table'
else
   echo 'not tested: what root may do and others may not'
fi

"$atrito" "$work/nowhere.inp" --quiet -o "$work/none" >"$work/said" 2>&1
code=$?
expect_5 'a deck that is not there' "$work/nowhere.inp"
[ -e "$work/none" ] && fail 'a deck that is not there: a folder was made'

finish
