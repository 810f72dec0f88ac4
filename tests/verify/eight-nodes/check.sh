. "$(dirname "$0")/../lib.sh"

# the same element in CalculiX (CPE8): 69 nodes, printed with 7 digits
run 0 "$here/beam.inp" beam --digits 17 --quiet
near 'nodes that CalculiX has, too' "$(awk 'NR == FNR { u[$1] = 1; next } !/^#/ && ($2 in u) { n++ } END { print n + 0 }' \
   "$here/beam.ccx" beam/nodes.tab)" 69 0
below 'largest difference from CalculiX, of the largest displacement' "$(awk '
   function size(v) { return v < 0 ? -v : v }
   NR == FNR { a[$1] = $2; b[$1] = $3; if (size($3) > most) most = size($3); next }
   !/^#/ { d = size($5 - a[$2]); e = size($6 - b[$2]); if (e > d) d = e; if (d > worst) worst = d }
   END { printf "%.17g", worst/most }' "$here/beam.ccx" beam/nodes.tab)" 1e-6

# bent WHAT TYPE LEVEL: pure bending, which rectangles of eight nodes have exactly
bent() {
   sed "s/TYPE=CPS8/TYPE=$1/" "$here/bent.inp" >"bent-$1.inp"
   run 0 "bent-$1.inp" "bent-$1-$2" --refine "$2" --digits 17 --quiet
   field_near "$1 bent, level $2, u1" "bent-$1-$2/nodes.tab" u1 '-1e-3*x*(y - 0.5)' 1e-15
   field_near "$1 bent, level $2, u2" "bent-$1-$2/nodes.tab" u2 '5e-4*(x*x + 0.3*(y - 0.5)^2)' 1e-15
   field_near "$1 bent, level $2, s11" "bent-$1-$2/stress.tab" s11 '-(y - 0.5)' 1e-11
   all_near "$1 bent, level $2, s22" "bent-$1-$2/stress.tab" s22 0 1e-11
   all_near "$1 bent, level $2, s12" "bent-$1-$2/stress.tab" s12 0 1e-11
   below "$1 bent, level $2, estimated error in %" "$(summary "bent-$1-$2" error_estimate_percent)" 1e-8
}
for level in 0 1 2; do
   bent CPS8 $level
done
bent CPS9 0

# Eight beside nine nodes in one body: a linear field, and the same refined.
for level in 0 1; do
   run 0 "$here/beside.inp" "beside-$level" --refine $level --digits 17 --quiet
   near "beside, level $level, bodies" "$(grep -c 'leave a crack' "beside-$level.err")" 0 0
   field_near "beside, level $level, u1" "beside-$level/nodes.tab" u1 '1e-3*x + 2e-3*y' 1e-15
   field_near "beside, level $level, u2" "beside-$level/nodes.tab" u2 '3e-3*y - 1e-3*x' 1e-15
   all_near "beside, level $level, s12" "beside-$level/stress.tab" s12 0.4 1e-12
done

# All elements of eight nodes on the mesh of a deck of nine, whose centres are then of no element.
run 0 "$here/bent.inp" eight --digits 17 --quiet
sed 's/TYPE=CPS8/TYPE=CPS9/' "$here/bent.inp" >nine.inp
"$atrito" study nine.inp --levels 1 --elements cps8 -o study --digits 17 --quiet 2>told || complain 'eight nodes on a mesh of nine'
near 'strain energy of eight on nine' "$(summary study/cps8_0 strain_energy)" "$(summary eight strain_energy)" 1e-15
finish
