#!/bin/sh
# The same scene from *BLOCK and from a line for every node and element: the same tables, but for the lines that name the deck.
. "$(dirname "$0")/../lib.sh"

sh "$here/../../bench/scene-p.sh" 20 >block.inp
sh "$here/../../bench/explicit-deck.sh" 20 >explicit.inp
[ "$(wc -l <explicit.inp)" -gt 2000 ] || complain 'the explicit deck is short'
run 0 block.inp block --quiet
run 0 explicit.inp explicit --quiet
for table in nodes stress reactions contact summary iterations; do
   grep -v '^# deck:\|^# heading:\|^# digest:\|^# parameters:' "block/$table.tab" >"block/$table.text"
   grep -v '^# deck:\|^# heading:\|^# digest:\|^# parameters:' "explicit/$table.tab" >"explicit/$table.text"
   [ -s "block/$table.text" ] || complain "$table.tab is missing"
   cmp "block/$table.text" "explicit/$table.text" || complain "$table.tab"
done
finish
