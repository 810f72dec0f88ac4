#!/bin/sh
# A library of MUMPS of another version than the header that the program was built with is not used: exit 9, and both versions are told.
#    other_mumps.sh ATRITO DECK, with such a library where it is loaded from
. "$(dirname "$0")/lib.sh"
atrito=$1
deck=$2

"$atrito" "$deck" --solver mumps --quiet -o "$work/out" >"$work/said" 2>&1
code=$?
[ $code -eq 9 ] || fail "exit $code, expected 9"
grep -q 'is version 4\.10\.0 of MUMPS, and this program was built for [0-9.]*: build it anew' "$work/said" || {
   fail 'the versions are not told'
   cat "$work/said"
}
[ ! -e "$work/out" ] || fail 'something was written'
finish
