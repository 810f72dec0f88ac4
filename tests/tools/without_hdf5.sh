#!/bin/sh
# A program built without HDF5 runs decks that ask for no field file, and refuses those that do: exit 2, each request at its place.
#    without_hdf5.sh ATRITO DECK
. "$(dirname "$0")/lib.sh"
atrito=$1
deck=$2

"$atrito" "$deck" --quiet -o "$work/plain" || fail "a deck without requests: exit $?"

sed '/^\*END STEP/d' "$deck" >"$work/fields.inp"
line=$(($(wc -l <"$work/fields.inp") + 1))
printf '*NODE FILE\nU\n*EL FILE\nS\n*CONTACT FILE\n*RESTART, WRITE\n*END STEP\n' >>"$work/fields.inp"
for task in '' check; do
   "$atrito" $task "$work/fields.inp" --quiet >"$work/said" 2>&1
   code=$?
   [ "$code" -eq 2 ] || fail "requests: exit $code, expected 2"
   for place in "$line:2" "$((line + 2)):2" "$((line + 4)):2" "$((line + 5)):2"; do
      grep -qF "fields.inp:$place: error [E-NOT-BUILT]" "$work/said" || fail "no E-NOT-BUILT at $place"
   done
   grep -qF 'no HDF5' "$work/said" || fail 'HDF5 is not named'
done
"$atrito" "$deck" --quiet --restart "$deck" -o "$work/plain" >"$work/said" 2>&1
code=$?
[ "$code" -eq 5 ] || fail "--restart: exit $code, expected 5"
grep -qF 'no HDF5' "$work/said" || fail '--restart: HDF5 is not named'
[ "$failures" -eq 0 ] || cat "$work/said"
finish
