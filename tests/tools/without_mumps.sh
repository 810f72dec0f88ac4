#!/bin/sh
# A program built without MUMPS solves large bodies all the same, and refuses --solver mumps: exit 1, and why.
#    without_mumps.sh ATRITO SCENE.sh
. "$(dirname "$0")/lib.sh"
atrito=$1
scene=$2

# a body of 40,000 equations, which the sparse solver would get
sh "$scene" 100 line >"$work/deck.inp"
"$atrito" "$work/deck.inp" --quiet -o "$work/out" || fail "automatic choice: exit $?"
grep -q '  sparse  ' "$work/out/deck.lst" || fail 'no body is sparse'
grep -q 'predicted cost' "$work/out/deck.lst" || fail 'the listing does not say why'

for task in '' check sweep; do
   "$atrito" $task "$work/deck.inp" --solver mumps >"$work/said" 2>&1
   code=$?
   [ "$code" -eq 1 ] || fail "$task --solver mumps: exit $code, expected 1"
   grep -qF 'needs MUMPS, and this build has none' "$work/said" || { fail 'MUMPS is not named'; cat "$work/said"; }
done

"$atrito" --version | grep -qxF 'MUMPS: not used: this build has none' || fail '--version does not say that there is no MUMPS'
finish
