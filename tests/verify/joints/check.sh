. "$(dirname "$0")/../lib.sh"

# worst_stress NAME ANGLE: in the axes of the stack s22 = -10 and nothing else.
worst_stress() {
   awk -v a="$2" '
      function off(x) { if (x !~ /n/ && x < 0) x = -x; if (x > worst || x ~ /n/) worst = x }
      BEGIN { a *= atan2(0, -1)/180; c = cos(a); s = sin(a) }
      /^# columns:/ { for (i = 3; i <= NF; i++) at[$i] = i - 2; next }
      /^#/ { next }
      { rows++; off($at["s11"] + 10*s*s); off($at["s22"] + 10*c*c); off($at["s12"] - 10*s*c) }
      END { if (rows == 0) print "none"; else printf "%.17g", worst }' "$1/stress.tab"
}

# worst_stress_of_none NAME: the largest size of a component.
worst_stress_of_none() {
   awk '/^# columns:/ { for (i = 3; i <= NF; i++) at[$i] = i - 2; next } /^#/ { next }
      { for (name in at) if (name ~ /^s[123]/) { v = $at[name]; if (v < 0) v = -v; if (v > worst || v ~ /n/) worst = v; n++ } }
      END { if (n == 0) print "none"; else printf "%.17g", worst }' "$1/stress.tab"
}

# moved NAME NODE: u1 u2 of a node.
moved() {
   awk -v n="$2" '/^# columns:/ { for (i = 3; i <= NF; i++) at[$i] = i - 2 } !/^#/ && $at["node"] == n { print $at["u1"], $at["u2"] }' \
      "$1/nodes.tab"
}

# 1. *TIE: patch tests on inclined rollers, either side slave
for sides in 3:2 2:3 1:10 10:1 4:4; do
   for type in CPS4 CPE9 CPS8; do
      for roles in 0 1; do
         for form in dense sparse; do
            name="patch-$(echo $sides | tr : -)-$type-$roles-$form"
            stack "$name" $form na=${sides%:*} nb=${sides#*:} type=$type exchange=$roles angle=30
            below "$name: stress" "$(worst_stress "$name" 30)" 1e-10
         done
      done
   done
done
all_near 'patch: traction upon the slave' patch-3-2-CPS4-0-dense/ties.tab t1 -5 1e-10
near 'patch: nodes that are tied' "$(column patch-3-2-CPS4-0-dense/ties.tab node | wc -l)" 3 0
says 'patch: resultant' patch-3-2-CPS4-0-dense/*.lst 'resultant upon the slave ......... -15, 25.9808 [F]'
near 'patch: linear solves, dense' "$(summary patch-3-2-CPS4-0-dense linear_solves)" 1 0
below 'patch: linear solves, sparse' "$(summary patch-3-2-CPS4-0-sparse linear_solves)" 9

# 2. other units: as many solves, forces times 1e4, lengths times 1e-3
for form in dense sparse; do
   stack "units-$form" $form na=7 nb=5 angle=30 unit=1e-3 force=1e4
   stack "plain-$form" $form na=7 nb=5 angle=30
   near "units, $form: linear solves" "$(summary units-$form linear_solves)" "$(summary plain-$form linear_solves)" 0
   same_tables "units, $form" plain-$form/nodes.tab units-$form/nodes.tab 1e-10 x=1e-3 y=1e-3 u1=1e-3 u2=1e-3
done

# 3. a tied cantilever: like one body where the sides match, within what the mesh allows where they do not
awk -v na=24 -v nb=24 -v layer=1 -f "$here/stack.awk" </dev/null | sed -e '/^\*TIE/,+1d' -e 's/ELSET=B, .*/&, MERGE=A/' >glued.inp
run 0 glued.inp glued --digits 17 --quiet
for sides in 24:24 24:17 16:24; do
   name="layers-$(echo $sides | tr : -)"
   stack "$name" dense na=${sides%:*} nb=${sides#*:} layer=1
   near "$name: energy over that of one body" "$(awk -v a="$(summary "$name" strain_energy)" -v b="$(summary glued strain_energy)" \
      'BEGIN { printf "%.17g", a/b }')" 1 "$([ $sides = 24:24 ] && echo 1e-11 || echo 0.02)"
done

# 4. gaps: closed by moving nodes, or left, without strain; nodes that are too far
stack closed dense na=3 nb=2 gap=0.03
run 0 closed.inp closed --digits 17
below 'closed: stress' "$(worst_stress closed 0)" 1e-10
says closed closed.err 'N-ADJUST'
near 'closed: where the slave is' "$(awk '!/^#/ && $2 == 17 { print $4 }' closed/nodes.tab)" 1 1e-15
stack left dense na=3 nb=2 gap=0.03 'options=, ADJUST=NO'
below 'left: stress' "$(worst_stress left 0)" 1e-10
near 'left: where the slave is' "$(awk '!/^#/ && $2 == 17 { print $4 }' left/nodes.tab)" 1.03 1e-15
awk -v na=3 -v nb=6 -f "$here/stack.awk" </dev/null | awk '/ELSET=B,/ { n = NR } NR == n + 2 && n { print "3, 1.2"; next } { print }' >wedge.inp
run 0 wedge.inp wedge --digits 17 --quiet
says wedge wedge.err 'W-TIE'
says wedge wedge.err 'nodes of the slave are farther than 0.05 from the master and are not tied, the first of them node 19'
near 'wedge: nodes that are tied' "$(column wedge/ties.tab node | wc -l)" 2 0

# 5. the elements of CalculiX: inclined rollers, a hinge, springs, a tie of matching sides
for form in dense sparse; do
   run 0 "$here/rows.inp" rows --digits 17 --quiet --contact $form
   below "rows, $form: largest difference from CalculiX, of the largest displacement" "$(awk '
      function size(v) { return v < 0 ? -v : v }
      FNR == NR { if (!/^#/) { a[$1] = $2; b[$1] = $3; if (size($3) > most) most = size($3) } next }
      !/^#/ { n++; d = size($5 - a[$2]); e = size($6 - b[$2]); if (e > d) d = e; if (d > worst) worst = d }
      END { if (n != 123) print "none"; else printf "%.17g", worst/most }' "$here/rows.ccx" rows/nodes.tab)" 1e-6
done

# 6. springs alone: two side by side, twice, in series; soft ones and hard ones
run 0 "$here/springs.inp" rigid --set k=1e15 --digits 17 --quiet
for k in 1e-5 50 1e6 1e15; do
   for form in dense sparse; do
      name="springs-$k-$form"
      run 0 "$here/springs.inp" "$name" --set k=$k --digits 17 --quiet --contact $form
      near "$name: what they add" "$(moved "$name" 17 | awk -v r="$(moved rigid 17)" '{ split(r, a, " "); printf "%.17g", $1 - a[1] }')" \
         "$(awk -v k=$k 'BEGIN { print 1/k }')" "$(awk -v k=$k 'BEGIN { print 1e-12 + 1e-9/k }')"
      near "$name: force" "$(awk '!/^#/ && $2 == 106 { print $8 }' "$name/springs.tab")" 0.5 1e-12
      near "$name: force between" "$(awk '!/^#/ && $2 == 107 { print $8 }' "$name/springs.tab")" -0.5 1e-12
   done
done

# 7. a tie and friction in one scene: both forms, and what slides
for form in dense sparse; do
   run 0 "$here/mixed.inp" "mixed-$form" --digits 17 --quiet --contact $form
   sed 's/^UP-LEFT, P, .*/UP-LEFT, P, 20./' "$here/mixed.inp" >pushed.inp
   run 4 pushed.inp pushed --contact $form
   says "pushed, $form" pushed.err 'bodies LOW and UP are free to move along x1 together under their loads: they slide'
   says "pushed, $form" pushed.err 'friction holds nu times N = 8 [F] at most'
done
same_tables 'mixed' mixed-dense/nodes.tab mixed-sparse/nodes.tab 1e-8
same_tables 'mixed' mixed-dense/ties.tab mixed-sparse/ties.tab 1e-7

# 8. the same equation twice
sed "s/^\*BOUNDARY/*EQUATION\n2\n$(grep ', 1, 1., .*, 1, -1.$' "$here/rows.inp" | head -1)\n*BOUNDARY/" "$here/rows.inp" >again.inp
for form in dense sparse; do
   run 0 again.inp again --digits 17 --contact $form
   says "again, $form" again.err 'N-SHARED'
   same_tables "again, $form" rows/nodes.tab again/nodes.tab 1e-9
done

# 9. cylindrical axes: a sector of a ring under pressure, its edges held against turning, stays a sector
awk -f "$here/ring.awk" </dev/null >ring.inp
run 0 ring.inp ring --digits 17 --quiet
near 'ring: edges move alike' "$(awk '/^# columns:/ { for (i = 3; i <= NF; i++) at[$i] = i - 2 } !/^#/ {
      r = sqrt($at["x"]^2 + $at["y"]^2); u[$at["node"]] = ($at["x"]*$at["u1"] + $at["y"]*$at["u2"])/r }
   END { printf "%.17g", u[1]/u[13] }' ring/nodes.tab)" 1 1e-11
near 'ring: displacement of the inner edge, as of a thick tube' "$(moved ring 1 | awk '{ print $1 }')" \
   "$(awk 'BEGIN { a = 1; b = 2; p = 10; e = 1000; m = 0.3; printf "%.17g", p*a/e*(a*a*(1 - m) + b*b*(1 + m))/(b*b - a*a) }')" 2e-5

# 10. an inclined roller that is moved: u_n as prescribed, and the reaction normal to it
sed 's/^\*DSLOAD/*BOUNDARY\nA-BOTTOM, 2, 2, 0.01\n*DSLOAD/; s/^A-BOTTOM, 2$//' patch-3-2-CPS4-0-dense.inp | grep -v '^$' >lifted.inp
run 0 lifted.inp lifted --digits 17 --quiet
near 'lifted: u_n' "$(moved lifted 3 | awk '{ printf "%.17g", -0.5*$1 + sqrt(0.75)*$2 }')" 0.01 1e-15
near 'lifted: sum of the reactions' "$(awk '!/^#/ { x += $3; y += $4 } END { printf "%.17g", sqrt(x*x + y*y) }' lifted/reactions.tab)" 30 1e-10
near 'lifted: reaction' "$(awk '!/^#/ { x += $3; y += $4 } END { printf "%.17g", y + x*sqrt(3) }' lifted/reactions.tab)" 0 1e-10

# 11. corners of tied blocks that touch the same node of a wall: what they ask depends on each other
for form in dense sparse; do
   run 0 "$here/wall.inp" "wall-$form" --digits 17 --contact $form
   says "wall, $form" "wall-$form.err" 'N-SHARED'
done
same_tables 'wall' wall-dense/nodes.tab wall-sparse/nodes.tab 1e-8
same_tables 'wall' wall-dense/ties.tab wall-sparse/ties.tab 1e-7

# 12. what a spring on a prescribed node takes is in the reaction
run 0 "$here/known.inp" known --digits 17 --quiet
near 'known: reaction' "$(awk '!/^#/ && $2 == 3 { print $4 }' known/reactions.tab)" -55 1e-12
near 'known: spring' "$(column known/springs.tab force)" -5 1e-12

# 13. periodic edges: equations over two sets, whose new nodes stand in other orders on a refined mesh
for level in 0 1 2; do
   for type in CPS4 CPE9; do
      sed "s/CPS4/$type/" "$here/periodic.inp" >periodic.inp
      run 0 periodic.inp periodic --digits 17 --quiet --refine $level
      below "periodic, level $level, $type: difference of the edges" "$(awk '
         function off(a, b) { a -= b; if (a < 0) a = -a; if (a > worst) worst = a }
         !/^#/ && ($3 == 0 || $3 == 4) { if ($4 in u) { n++; off(u[$4], $5); off(v[$4], $6) } u[$4] = $5; v[$4] = $6 }
         END { if (n < 4) print "none"; else printf "%.17g", worst }' periodic/nodes.tab)" 1e-15
   done
done

# 14. tied curves whose chords do not match turn as one without strain, whichever is the slave, and so they do over a gap
for type in CPE4 CPE8 CPE3; do
   for roles in B-LEFT,A-RIGHT A-RIGHT,B-LEFT; do
      for adjust in YES NO; do
         sed "s/CPE4/$type/; s/^B-LEFT, A-RIGHT/$roles/; s/^\*TIE.*/&, ADJUST=$adjust/" "$here/turned.inp" >turned.inp
         run 0 turned.inp turned --digits 17 --quiet
         below "turned, $type, $roles, ADJUST=$adjust: stress" "$(worst_stress_of_none turned)" 1e-8
      done
   done
done

# SPRINGA along (0.6, 0.8) to a node that is held, in either order: a push of 6 along x needs a thrust of 10
axial() { # axial ENDS [LINE]
   printf '%s\n' '*NODE, NSET=ALL' '1, 0, 0' '2, 1, 0' '3, 1, 1' '4, 0, 1' '*NODE' '101, 4, 5' '*ELEMENT, TYPE=CPS4, ELSET=B' '1, 1, 2, 3, 4' '*ELEMENT, TYPE=SPRINGA, ELSET=S' \
      "11, $1" '*SPRING, ELSET=S' "${2-}" 50. '*MATERIAL, NAME=M' '*ELASTIC' '1000, 0.3' '*SOLID SECTION, ELSET=B, MATERIAL=M' '*BOUNDARY' 'ALL, 2' '101, 1, 2' \
      '*STEP' '*STATIC' '*CLOAD' '3, 1, 6' '*NODE PRINT' U '*END STEP'
}
for ends in '3, 101' '101, 3'; do
   axial "$ends" >axial.inp
   run 0 axial.inp axial --digits 17 --quiet
   near "thrust of SPRINGA $ends" "$(column axial/springs.tab force)" -10 1e-12
   near "shortening of SPRINGA $ends" "$(column axial/springs.tab relative_u)" -0.2 1e-14
   near "end of SPRINGA $ends" "$(awk '!/^#/ && $2 == 3 { print $5 }' axial/nodes.tab)" "$(value 0.2/0.6)" 1e-13
done
finish
