. "$(dirname "$0")/../lib.sh"

# wall FILE WAY WIDE COURSES NX LAW [more of wall.awk]
wall() {
   file=$1
   way=$2
   wide=$3
   courses=$4
   nx=$5
   law=$6
   shift 6
   awk -v way="$way" -v wide="$wide" -v courses="$courses" -v nx="$nx" -v law="$law" -v nodes=1 "$@" -f "$here/wall.awk" >"$file.inp"
}

same() { # A B: two folders of tables; the loads have other sets, so that resultants.tab has other rows
   rm -f "$1/resultants.tab" "$2/resultants.tab"
   "$atrito" compare "$1" "$2" --rtol 1e-12 >"$1-$2.cmp" || { complain "$1 and $2 differ"; head -20 "$1-$2.cmp"; }
   tail -1 "$1-$2.cmp"
}

# Local friction, hard contact: pair by pair the same tables.
wall local found 5 5 4 0.6
wall local-pairs pairs 5 5 4 0.6
run 0 local.inp local --digits 17 --quiet
run 0 local-pairs.inp local-pairs --digits 17 --quiet
same local local-pairs

# Softer joints that slide, in the sparse form.
wall soft found 6 4 4 0.3 -v slope=1e6 -v push=0.28
wall soft-pairs pairs 6 4 4 0.3 -v slope=1e6 -v push=0.28
run 0 soft.inp soft --contact sparse --digits 17 --quiet
run 0 soft-pairs.inp soft-pairs --contact sparse --digits 17 --quiet
same soft soft-pairs
below 'points that slide, none' "$(summary soft slip_points | awk '{ n += $1 } END { print n == 0 }')" 0.5

# Nonlocal friction: the average goes over a whole bed joint, which pairs with a half of it each as slave would cut.
law='0.35, 1e-6, 0.6'
wall wide found 5 5 8 "$law" -v push=0.3
wall wide-sides sides 5 5 8 "$law" -v push=0.3
wall wide-pairs pairs 5 5 8 "$law" -v push=0.3
for deck in wide wide-sides wide-pairs; do
   run 0 $deck.inp $deck --digits 17 --quiet
done
same_tables 'nodes, averages over bed joints' wide/nodes.tab wide-sides/nodes.tab 1e-12
# (s runs along the slave surface, which is the whole joint there)
for side in wide wide-sides wide-pairs; do
   awk '/^# columns:/ { for (i = 3; i <= NF; i++) if ($i == "s") s = i - 2 } !/^#/ { $s = 0 } { print }' $side/contact.tab >$side.contact
done
same_tables 'contact, averages over bed joints' wide.contact wide-sides.contact 1e-11
if "$atrito" compare wide/contact.tab wide-pairs/contact.tab --rtol 1e-3 >cut.cmp; then
   complain 'averages that are cut at the joints below make no difference: the comparison proves nothing'
fi

# A thousand blocks in 40 lines: as many pairs as there are joints, and no word.
awk -v way=found -v wide=43 -v courses=23 -v nx=8 -v law=0.6 -f "$here/wall.awk" >thousand.inp
near 'lines of deck, beyond 40' "$(awk 'END { print (NR > 40 ? NR - 40 : 0) }' thousand.inp)" 0 0
"$atrito" check thousand.inp >thousand.out 2>thousand.err || complain 'a thousand blocks are refused'
[ -s thousand.err ] && { complain 'a thousand blocks, with messages'; head -20 thousand.err; }
# head joints: 12 courses of 42, 11 of 43; bed joints: 22 between courses, of 86 halves each
near 'pairs' "$(awk '/contact pairs/ { print $NF }' thousand.out)" $((12*42 + 11*43 + 22*86)) 0
finish
