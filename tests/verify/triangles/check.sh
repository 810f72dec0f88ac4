. "$(dirname "$0")/../lib.sh"

# the same elements in CalculiX, printed with 7 digits
for type in CPE3 CPE6; do
   awk -v type=$type -f "$here/beam.awk" </dev/null >beam-$type.inp
   run 0 beam-$type.inp beam-$type --digits 17 --quiet
   case $type in *3) nodes=36 ;; *) nodes=119 ;; esac
   near "$type: nodes that CalculiX has, too" "$(awk 'NR == FNR { u[$1] = 1; next } !/^#/ && ($2 in u) { n++ } END { print n + 0 }' \
      "$here/beam-$type.ccx" beam-$type/nodes.tab)" $nodes 0
   below "$type: largest difference from CalculiX, of the largest displacement" "$(awk '
      function size(v) { return v < 0 ? -v : v }
      NR == FNR { a[$1] = $2; b[$1] = $3; if (size($3) > most) most = size($3); next }
      !/^#/ { d = size($5 - a[$2]); e = size($6 - b[$2]); if (e > d) d = e; if (d > worst) worst = d }
      END { printf "%.17g", worst/most }' "$here/beam-$type.ccx" beam-$type/nodes.tab)" 2e-7
done

# Pure bending, which triangles of six nodes have exactly; the blocks of eight nodes are those of ../eight-nodes.
for type in CPS6 CPE6; do
   # in plane strain mu/(1 - mu) is what mu is in plane stress
   mu=0.3; young=1
   [ $type = CPE6 ] && mu=$(value 0.3/0.7) && young=$(value 1/0.91)
   sed "s/TYPE=CPS8/TYPE=$type/; s/0\.3\*(y/$mu*(y/" "$here/../eight-nodes/bent.inp" >bent-$type.inp
   for level in 0 1 2; do
      out=bent-$type-$level
      run 0 bent-$type.inp $out --refine $level --digits 17 --quiet
      field_near "$out u1" $out/nodes.tab u1 '-1e-3*x*(y - 0.5)' 1e-15
      field_near "$out u2" $out/nodes.tab u2 "5e-4*(x*x + $mu*(y - 0.5)^2)" 1e-15
      field_near "$out s11" $out/stress.tab s11 "-$young*(y - 0.5)" 1e-11
      all_near "$out s22" $out/stress.tab s22 0 1e-11
      all_near "$out s12" $out/stress.tab s12 0 1e-11
      below "$out estimated error in %" "$(summary $out error_estimate_percent)" 1e-8
   done
done

# A block of no parallelograms: its triangles have straight sides, so they contain quadratic displacements all the same.
sed 's/TYPE=CPS8/TYPE=CPS6/; s/^4, 1$/3.5, 1.2/' "$here/../eight-nodes/bent.inp" >skew.inp
for level in 0 1; do
   run 0 skew.inp skew-$level --refine $level --digits 17 --quiet
   field_near "skew-$level u1" skew-$level/nodes.tab u1 '-1e-3*x*(y - 0.5)' 1e-15
   field_near "skew-$level s11" skew-$level/stress.tab s11 '-(y - 0.5)' 1e-11
   all_near "skew-$level s12" skew-$level/stress.tab s12 0 1e-11
done

# Triangles beside quadrilaterals in one body: a linear field, and the same refined.
for pair in CPE3-CPE3 CPE3-CPE4 CPE4-CPE3 CPE6-CPE6 CPE6-CPE8 CPE6-CPE9 CPE9-CPE6; do
   sed "s/FIRST/${pair%-*}/; s/SECOND/${pair#*-}/" "$here/beside.inp" >"$pair.inp"
   for level in 0 1; do
      out=$pair-$level
      run 0 $pair.inp "$out" --refine $level --digits 17 --quiet
      near "$out, cracks" "$(grep -c 'leave a crack' "$out.err")" 0 0
      field_near "$out u1" "$out/nodes.tab" u1 '1e-3*x + 2e-3*y' 1e-15
      field_near "$out u2" "$out/nodes.tab" u2 '3e-3*y - 1e-3*x' 1e-15
      all_near "$out s12" "$out/stress.tab" s12 0.4 1e-12
      below "$out estimated error in %" "$(summary "$out" error_estimate_percent)" 1e-8
   done
done

# All elements of three nodes on the mesh of a deck of six, and the other way round; no triangles of quadrilaterals.
sed 's/FIRST/CPE3/; s/SECOND/CPE3/' "$here/beside.inp" >three.inp
run 0 three.inp three --refine 1 --digits 17 --quiet
"$atrito" study CPE6-CPE6.inp --levels 1 --elements cpe3,cpe6 -o study --digits 17 --quiet 2>told || complain 'three nodes on a mesh of six'
near 'strain energy of three on six' "$(summary study/cpe3_0 strain_energy)" "$(summary three strain_energy)" 1e-14
"$atrito" study three.inp --levels 1 --elements cpe6 -o study --digits 17 --quiet 2>told || complain 'six nodes on a mesh of three'
"$atrito" study three.inp --levels 1 --elements cpe4 -o study --digits 17 --quiet 2>told
[ $? -eq 2 ] || complain 'quadrilaterals of triangles: not exit 2'
says 'quadrilaterals of triangles' told 'the deck has triangles, of which --elements makes none'
"$atrito" study CPE3-CPE4.inp --levels 1 --elements cpe3 -o study --digits 17 --quiet 2>told
[ $? -eq 2 ] || complain 'triangles of quadrilaterals: not exit 2'
says 'triangles of quadrilaterals' told 'the deck has quadrilaterals, of which --elements makes none'
finish
