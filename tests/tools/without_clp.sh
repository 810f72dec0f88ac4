#!/bin/sh
# A program built without Clp solves what has a solution; of what has none it says that it cannot tell: exit 3, and why, never 4.
#    without_clp.sh ATRITO DECK.inp
. "$(dirname "$0")/lib.sh"
atrito=$1
deck=$2

"$atrito" "$deck" --quiet -o "$work/rests" || fail "a block at rest: exit $?"

"$atrito" "$deck" --set side=0.1 -o "$work/slides" >"$work/said" 2>&1
code=$?
[ "$code" -eq 3 ] || fail "a block that slides: exit $code, expected 3"
grep -qF 'cannot be told without Clp: this build has none' "$work/said" || { fail 'Clp is not named'; cat "$work/said"; }
grep -qF 'would move along x1' "$work/said" || { fail 'the body that moved is not told'; cat "$work/said"; }
grep -q 'is free to' "$work/said" && fail 'a motion is told that is not proved'
head -n 1 "$work/slides/nodes.tab" | grep -qxF '# NOT CONVERGED' || fail 'the tables are not marked'

# a limit is a proof on one side, so it says at once that there will be none
"$atrito" limit "$deck" --vary side=0:1 -o "$work/limit" >"$work/said" 2>&1
code=$?
[ "$code" -eq 1 ] || fail "limit: exit $code, expected 1"
grep -qF 'limit needs Clp, to prove that a scene falls: this build has none' "$work/said" || { fail 'limit does not name Clp'; cat "$work/said"; }
[ ! -e "$work/limit" ] || fail 'limit writes something'

# a body that nothing touches needs no linear programme
sed -e '/^\*SURFACE, NAME=FLOOR/,/^CRATE-BOTTOM/d' "$deck" >"$work/alone.inp"
"$atrito" "$work/alone.inp" -o "$work/alone" >"$work/said" 2>&1
code=$?
[ "$code" -eq 4 ] || fail "a block alone: exit $code, expected 4"
"$atrito" --version | grep -qxF 'Clp: not used: this build has none' || fail '--version does not say that there is no Clp'
finish
