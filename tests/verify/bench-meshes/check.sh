. "$(dirname "$0")/../lib.sh"
limit=$4
python=$5
bench=$here/../../bench
export PYTHONDONTWRITEBYTECODE=1
rm -rf decks
sh "$bench/run-meshes.sh" -n 1 -k 'a p a-moved p-moved rotated' -d decks -p "$python" "$atrito" 2e3 >table 2>said || { complain 'run-meshes.sh'; cat said; }
[ "$(dirname "$atrito")" = "$(dirname "$limit")" ] || complain 'run-meshes.sh looks for the limit program next to atrito'
cat table
near 'rows' "$(grep -cE '^(a|p|a-moved|p-moved|rotated) +2e3 +[0-9]+ ' table)" 5 0
near 'rows that are not solved' "$(grep -c '!' table)" 0 0
near 'columns beyond 100' "$(awk 'length($0) > 100' table | grep -cv '^machine\|^BLAS')" 0 0
# elements of 1/22, since 1/20 is exact in 12 digits: 45 x 23 nodes and 23 x 12, of which 45 and 23 are held
near 'displacements of scene P' "$(awk '$1 == "p" { print $3 }' table)" 2486 0

# 12 digits of the coordinates: 1e-12 of the contact's stiffness is far below 1e-9 of its forces
sh "$bench/scene-p.sh" 22 >block.inp
run 0 block.inp block --quiet
run 0 decks/p-2e3.inp p --quiet
for table in nodes reactions stress contact; do
   "$atrito" compare "block/$table.tab" "p/$table.tab" --rtol 1e-8 >said || { complain "$table of scene P"; cat said; }
done

# nodes FILE: number x y
nodes() {
   awk '/^[*]/ { mesh = /^[*]NODE$/; next } mesh { gsub(",", ""); print }' "$1"
}
nodes decks/p-2e3.inp >p.nodes
nodes decks/p-moved-2e3.inp >moved.nodes
paste -d ' ' p.nodes moved.nodes | awk '
   function size(a) { return a < 0 ? -a : a }
   $1 != $4 { bad = 1 }
   { on = $2 == 0 || $2 == 2 || $3 == 0 || $3 == 1 || $3 == 1.5 || ($3 > 1 && ($2 == .5 || $2 == 1.5))
     d = size($2 - $5) > size($3 - $6) ? size($2 - $5) : size($3 - $6)
     if (on && d > 0) bad = 1
     if (!on && d == 0) bad = 1
     if (d > most) most = d }
   END { print most*22, bad + 0 }' >moves
below 'largest move in sides, at most .15' "$(cut -d ' ' -f 1 moves)" 0.1500001
near 'it is more than .14 among some 1,000 nodes' "$(awk '{ print ($1 > .14) }' moves)" 1 0
near 'nodes that should not move, or should' "$(cut -d ' ' -f 2 moves)" 0 0

# the first element of the turned scene: 25 times as long as high, along the diagonal
nodes decks/rotated-2e3.inp >rotated.nodes
awk '/^[*]ELEMENT/ { getline; gsub(",", ""); print $2, $3, $5; exit }' decks/rotated-2e3.inp >corners
read -r a b d <corners
awk -v a="$a" -v b="$b" -v d="$d" '{ x[$1] = $2; y[$1] = $3 }
   END { print sqrt(((x[b] - x[a])^2 + (y[b] - y[a])^2)/((x[d] - x[a])^2 + (y[d] - y[a])^2)), (y[b] - y[a])/(x[b] - x[a]) }' rotated.nodes >shape
near 'length over height' "$(cut -d ' ' -f 1 shape)" 25 1e-4
near 'slope' "$(cut -d ' ' -f 2 shape)" 1 1e-9
finish
