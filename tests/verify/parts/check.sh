#!/bin/sh
# Decks in parts: the same tables as from flat decks, and a closed form.
. "$(dirname "$0")/../lib.sh"
decks=$here/../../peers/decks

# same NAME TABLES [options]: a deck in parts and its flat one.
same() {
   name=$1
   tables=$2
   shift 2
   run 0 "$decks/$name.inp" parts --quiet "$@"
   run 0 "$here/$name-flat.inp" flat --quiet "$@"
   for table in $tables; do
      for folder in parts flat; do grep -v '^# deck:\|^# heading:\|^# digest:\|^# parameters:' "$folder/$table.tab" >"$folder/$table.text"; done
      [ "$(wc -l <"parts/$table.text")" -gt 4 ] || complain "$name $*: $table.tab is short"
      cmp "parts/$table.text" "flat/$table.text" || complain "$name $*: $table.tab"
   done
}

same cae-two-instances 'nodes contact reactions summary'
column parts/contact.tab status | grep -q 2 || complain 'nothing slips'
same cae-two-instances 'nodes contact reactions summary' --refine 1
same cae-rigid-punch 'nodes contact reactions rigid summary'
same cae-rigid-punch 'nodes contact reactions rigid summary' --refine 1

# bodies are called after their instances
run 0 "$decks/cae-style.inp" style
says 'bodies' style/cae-style.lst '   Punch-1 '

# the numbers of the second instance begin at 101, those of the assembly at 201
run 0 "$decks/cae-two-disks.inp" disks --digits 17
field_near 'radial displacement' disks/nodes.tab u1 'node > 200 ? 0 : 0.3*10*x/200000' 1e-16
field_near 'axial displacement' disks/nodes.tab u2 'node > 200 ? 0 : -10*y/200000' 1e-16
near 'nodes' "$(column disks/nodes.tab node | tail -1)" 201 0
grep -Eq '^   Disk-2 +Disk +101 +0 +1 ' disks/cae-two-disks.lst || complain 'listing'

# local axes of a part: those of node 2 are at 45 degrees in the part, so at 135 in the scene
run 0 "$here/quarter.inp" quarter --digits 17
row() { awk -v k="$1" '!/^#/ && $2 == 2 { print $k }' quarter/nodes.tab; }
near 'x of node 2' "$(row 3)" 0 0
near 'y of node 2' "$(row 4)" 1 0
near 'u1 of node 2' "$(row 5)" "$(value '-0.01/sqrt(2)')" 1e-17
near 'u2 of node 2' "$(row 6)" "$(value '0.01/sqrt(2)')" 1e-17

# the axes of a material turn with the instance: 2/1000 along the stiff one, in both
run 0 "$here/orthotropic.inp" wood --digits 17
row() { awk -v n="$1" -v k="$2" '!/^#/ && $2 == n { print $k }' wood/nodes.tab; }
near 'the lying square' "$(row 3 5)" 0.002 1e-16
near 'the standing square' "$(row 103 6)" 0.002 1e-16
finish
