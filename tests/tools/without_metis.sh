#!/bin/sh
# A program built without METIS orders by the places of the elements what METIS would order.
#    without_metis.sh ATRITO RING.sh
. "$(dirname "$0")/lib.sh"
atrito=$1
ring=$2

sh "$ring" 3000 >"$work/ring.inp"
"$atrito" "$work/ring.inp" --quiet -o "$work/out" || fail "a ring of flat elements: exit $?"
grep -q 'order of elimination by places' "$work/out/ring.lst" || fail 'the order is not told'
"$atrito" --version | grep -qxF 'METIS: not used: this build has none' || fail '--version does not say that there is no METIS'
finish
