. "$(dirname "$0")/../lib.sh"

# extreme FOLDER QUANTITY COLUMN [STEP INCREMENT]: of a row of extremes.tab.
extreme() {
   awk -v q="$2" -v wanted="$3" -v step="${4:-1}" -v increment="${5:-1}" '
      /^# columns:/ { for (i = 3; i <= NF; i++) place[$i] = i - 2 }
      !/^#/ && $2 == q && $1 == step && $NF == increment { print $place[wanted] }' "$1/extremes.tab"
}

# resultant FOLDER SET KEYWORD COLUMN [STEP INCREMENT]: of a row of resultants.tab.
resultant() {
   awk -v set="$2" -v keyword="$3" -v wanted="$4" -v step="${5:-1}" -v increment="${6:-1}" '
      /^# columns:/ { for (i = 3; i <= NF; i++) place[$i] = i - 2 }
      !/^#/ && $2 == set && $3 == keyword && $1 == step && $NF == increment { print $place[wanted] }' "$1/resultants.tab"
}

# in_balance FOLDER TOLERANCE: in every increment supports and loads add up to nothing.
in_balance() {
   below "$1: imbalance of supports and loads" "$(awk '
      /^# columns:/ { for (i = 3; i <= NF; i++) place[$i] = i - 2; next }
      /^#/ { next }
      { rows++
        for (k = 1; k <= 3; k++) {
           v = $place[(k == 1) ? "fx" : (k == 2) ? "fy" : "moment"]
           sum[k, $1, $NF] += v; if (v < 0) v = -v; size[k] += v; if (k < 3) size[3 - k] += v } }
      END { if (rows == 0) { print "none"; exit }
         for (key in sum) { split(key, part, SUBSEP); d = sum[key]; if (d < 0) d = -d
            if (size[part[1]] > 0 && d/size[part[1]] > worst) worst = d/size[part[1]] }
         printf "%.17g", worst }' "$1/resultants.tab")" "$2"
}

# bar ELASTIC STEPS...: 3 x 0.5 from (1, 2), held at its left end; the steps follow
bar() {
   cat <<DECK
*HEADING
A bar
*BLOCK, TYPE=CPS4, ELSET=BAR, NX=6, NY=2
1, 2
4, 2
4, 2.5
1, 2.5
*NSET, NSET=FOOT
1
*MATERIAL, NAME=A
*ELASTIC
1000, 0.3
*SOLID SECTION, ELSET=BAR, MATERIAL=A
2
*BOUNDARY
BAR-LEFT, 1
FOOT, 2
DECK
   cat
}

# tension: q = 10 on a face of 0.5 x 2
bar >bar.inp <<DECK
*STEP
*STATIC
*DSLOAD
BAR-RIGHT, P, -10
*NODE PRINT
U, RF
*EL PRINT, POSITION=AVERAGED AT NODES
S
*END STEP
DECK
run 0 bar.inp bar --digits 17
near 'bar: u1 max' "$(extreme bar u1_max value)" 0.03 1e-15
near 'bar: x of u1 max' "$(extreme bar u1_max x)" 4 0
near 'bar: u1 min' "$(extreme bar u1_min value)" 0 0
near 'bar: u2 min' "$(extreme bar u2_min value)" -0.0015 1e-15
near 'bar: y of u2 min' "$(extreme bar u2_min y)" 2.5 0
near 'bar: u' "$(extreme bar u value)" "$(value 'sqrt(0.03^2 + 0.0015^2)')" 1e-15
near 'bar: node of u' "$(extreme bar u node_or_element)" 21 0
near 'bar: mises' "$(extreme bar mises value)" 10 1e-11
near 'bar: node of mises, the first of all that are alike' "$(extreme bar mises node_or_element)" 1 0
near 'bar: s1 max' "$(extreme bar s1_max value)" 10 1e-11
near 'bar: s3 min' "$(extreme bar s3_min value)" 0 1e-11
all_near 'bar: s11 at the nodes' bar/nodal_stress.tab s11 10 1e-11
all_near 'bar: mises at the nodes' bar/nodal_stress.tab mises 10 1e-11
all_near 'bar: s22 at the nodes' bar/nodal_stress.tab s22 0 1e-11
near 'bar: nodes' "$(grep -vc '^#' bar/nodal_stress.tab)" 21 0
near 'bar: fx of the support' "$(resultant bar BAR-LEFT BOUNDARY fx)" -10 1e-12
near 'bar: moment of the support' "$(resultant bar BAR-LEFT BOUNDARY moment)" 22.5 1e-11
near 'bar: fy of the foot' "$(resultant bar FOOT BOUNDARY fy)" 0 1e-12
near 'bar: fx of the load' "$(resultant bar BAR-RIGHT DSLOAD fx)" 10 1e-14
near 'bar: moment of the load' "$(resultant bar BAR-RIGHT DSLOAD moment)" -22.5 1e-13
in_balance bar 1e-12
absent bar/stress.tab
# a stranger finds them on the screen
says 'bar: the screen' bar.out 'displaced    at most 0.030037 [L] at node 21 (4, 2.5)'
says 'bar: the screen' bar.out 'stressed     at most 10 [F/L^2], mises, at node 1 (1, 2)'
says 'bar: the screen' bar.out 'held by      BAR-LEFT (-10, 0), FOOT (0, 0) [F]'
grep -Eq '^   [*]BOUNDARY BAR-LEFT +-10 +0 +22.5$' bar/bar.lst || complain 'bar: the listing, a support'
grep -Eq '^   mises \[F/L\^2\] +10 +1 +1 +2$' bar/bar.lst || complain 'bar: the listing, a largest value'

# with the numbers of nodes; what two lines hold counts for the last
sed 's/^BAR-LEFT, 1$/BAR-LEFT, 1\n1, 1\n8, 1\n15, 1/' bar.inp >nodes.inp
run 0 nodes.inp nodes --digits 17 --quiet
near 'nodes: the middle one' "$(resultant nodes 8 BOUNDARY fx)" -5 1e-12
near 'nodes: one at the end' "$(resultant nodes 15 BOUNDARY fx)" -2.5 1e-12
[ -z "$(resultant nodes BAR-LEFT BOUNDARY fx)" ] || complain 'nodes: a set that holds nothing has a row'
in_balance nodes 1e-12
# refined, the nodes between hold with the first of their edge
run 0 nodes.inp nodes-refined --refine 1 --digits 17 --quiet
in_balance nodes-refined 1e-12

# in time: a force along a curve, then a second step that takes it away and presses
bar >time.inp <<DECK
*AMPLITUDE, NAME=CURVE
0., 0., 0.5, 2., 1., 1.
*STEP
*STATIC
0.2, 1.
*CLOAD, AMPLITUDE=CURVE
21, 1, 4.
*DLOAD
BAR, BX, 0.5
*NODE PRINT, FREQUENCY=1
U
*END STEP
*STEP
*STATIC
0.25, 1.
*CLOAD, OP=NEW
*DSLOAD
BAR-RIGHT, P, 8.
*NODE PRINT, FREQUENCY=2
U
*END STEP
DECK
run 0 time.inp time --digits 17 --quiet
for k in 1 2 3 4 5; do
   near "time: force in increment $k" "$(resultant time 21 CLOAD fx 1 $k)" \
      "$(value "4*($k/5 < 0.5 ? 4*$k/5 : 3 - 2*$k/5)")" 1e-13
   near "time: body force in increment $k" "$(resultant time BAR DLOAD fx 1 $k)" "$(value "1.5*$k/5")" 1e-13
done
for k in 2 4; do
   near "time: force that goes in increment $k" "$(resultant time 21 CLOAD fx 2 $k)" "$(value "4*(1 - $k/4)")" 1e-13
   near "time: pressure in increment $k" "$(resultant time BAR-RIGHT DSLOAD fx 2 $k)" "$(value "-8*$k/4")" 1e-13
   near "time: body force that stays in increment $k" "$(resultant time BAR DLOAD fx 2 $k)" 1.5 1e-13
done
[ -z "$(resultant time 21 CLOAD fx 2 1)$(extreme time u value 2 1)" ] || complain 'time: an increment that is not printed'
in_balance time 1e-12
near 'time: u1 at the end' "$(extreme time u1_min value 2 4)" "$(awk '!/^#/ && $1 == 2 && $NF == 4 && (n++ == 0 || $5 < m) { m = $5 }
   END { print m }' time/nodes.tab)" 1e-12

# a cantilever, P = 1 in shear at its end
cat >cantilever.inp <<DECK
*BLOCK, TYPE=CPS9, ELSET=BEAM, NX=40, NY=2
0, -0.5
20, -0.5
20, 0.5
0, 0.5
*MATERIAL, NAME=A
*ELASTIC
1000, 0.
*SOLID SECTION, ELSET=BEAM, MATERIAL=A
*BOUNDARY
BEAM-LEFT, 1, 2
*STEP
*STATIC
*DSLOAD
BEAM-RIGHT, TRVEC, 1., 0., -1.
*END STEP
DECK
run 0 cantilever.inp cantilever --digits 17 --quiet
near 'cantilever: deflection' "$(extreme cantilever u2_min value)" "$(value '-(4*20^3 + 2.4*20)/1000')" 0.03
near 'cantilever: x of it' "$(extreme cantilever u2_min x)" 20 0
near 'cantilever: largest stress' "$(extreme cantilever s1_max value)" 120 2
near 'cantilever: place of it' "$(extreme cantilever s1_max y)" 0.5 0
near 'cantilever: fy of the clamp' "$(resultant cantilever BEAM-LEFT BOUNDARY fy)" 1 1e-9
near 'cantilever: its moment' "$(resultant cantilever BEAM-LEFT BOUNDARY moment)" 20 1e-8
in_balance cantilever 1e-10

# a thick ring, held at its ends, under p = 12
cat >ring.inp <<DECK
*BLOCK, TYPE=CAX9, ELSET=RING, NX=20, NY=1
1, 3
2, 3
2, 3.2
1, 3.2
*MATERIAL, NAME=A
*ELASTIC
1000, 0.25
*SOLID SECTION, ELSET=RING, MATERIAL=A
*BOUNDARY
RING-BOTTOM, 2
RING-TOP, 2
*STEP
*STATIC
*DSLOAD
RING-LEFT, P, 12.
*END STEP
DECK
run 0 ring.inp ring --digits 17 --quiet
near 'ring: u1 of the bore' "$(extreme ring u1_max value)" "$(value '1.25*12/(1000*3)*((1 - 0.5)*1 + 4)')" 1e-7
near 'ring: its place' "$(extreme ring u1_max x)" 1 0
near 'ring: hoop stress' "$(extreme ring s1_max value)" 20 2e-2
near 'ring: pressure' "$(extreme ring s3_min value)" -12 4e-2
near 'ring: force of the top' "$(resultant ring RING-TOP BOUNDARY fy)" "$(value '2*0.25*12*atan2(0, -1)')" 1e-3
near 'ring: what is radial balances itself' "$(resultant ring RING-LEFT DSLOAD fx)" 0 0
near 'ring: moments, too' "$(resultant ring RING-TOP BOUNDARY moment)" 0 0
in_balance ring 1e-10

# two strips side by side, stretched by 0.001
cat >strips.inp <<DECK
*BLOCK, TYPE=CPS4, ELSET=SOFT, NX=4, NY=3
0, 0
2, 0
2, 1
0, 1
*BLOCK, TYPE=CPS4, ELSET=STIFF, NX=4, NY=3, MERGE=SOFT
0, 1
2, 1
2, 2
0, 2
*MATERIAL, NAME=A
*ELASTIC
1000, 0.
*MATERIAL, NAME=B
*ELASTIC
3000, 0.
*SOLID SECTION, ELSET=SOFT, MATERIAL=A
*SOLID SECTION, ELSET=STIFF, MATERIAL=B
*BOUNDARY
SOFT-LEFT, 1
STIFF-LEFT, 1
1, 2
*STEP
*STATIC
*BOUNDARY
SOFT-RIGHT, 1, 1, 0.002
STIFF-RIGHT, 1, 1, 0.002
*EL PRINT, ELSET=SOFT, POSITION=AVERAGED AT NODES
S
*EL PRINT, ELSET=STIFF
S
*END STEP
DECK
run 0 strips.inp strips --digits 17 --quiet
field_near 'strips: s11, and the mean between them' strips/nodal_stress.tab s11 'y < 0.99 ? 1 : 2' 1e-12
field_near 'strips: mises' strips/nodal_stress.tab mises 'y < 0.99 ? 1 : 2' 1e-12
near 'strips: nodes of the soft one' "$(grep -vc '^#' strips/nodal_stress.tab)" 20 0
near 'strips: points of the stiff one' "$(grep -vc '^#' strips/stress.tab)" 48 0
near 'strips: mises' "$(extreme strips mises value)" 3 1e-12
# what they have in common is of the later line
near 'strips: force of the soft one' "$(resultant strips SOFT-RIGHT BOUNDARY fx)" "$(value 5/6)" 1e-12
near 'strips: force of both' "$(value "$(resultant strips SOFT-RIGHT BOUNDARY fx) + $(resultant strips STIFF-RIGHT BOUNDARY fx)")" \
   4 1e-12
in_balance strips 1e-12

# a block on a rigid floor, weight 6, pushed by 1 at its middle; then by a punch that comes down
floor() {
   cat <<DECK
*BLOCK, TYPE=CPE4, ELSET=BLOCK, NX=6, NY=4
0, 0
3, 0
3, 2
0, 2
*MATERIAL, NAME=A
*ELASTIC
1000, 0.3
*SOLID SECTION, ELSET=BLOCK, MATERIAL=A
*SURFACE, NAME=FLOOR, TYPE=SEGMENTS
START, -1, 0
LINE, 5, 0
*RIGID BODY, ANALYTICAL SURFACE=FLOOR
*SURFACE INTERACTION, NAME=JOINT
*FRICTION
0.5
*CONTACT PAIR, INTERACTION=JOINT
BLOCK-BOTTOM, FLOOR
DECK
   cat
}
floor >floor.inp <<DECK
*STEP
*STATIC
*DLOAD
BLOCK, BY, -1.
*DSLOAD
BLOCK-LEFT, P, 0.5
*END STEP
DECK
run 0 floor.inp floor --digits 17 --quiet
near 'floor: fy' "$(resultant floor FLOOR RIGID_BODY fy)" 6 1e-9
near 'floor: fx' "$(resultant floor FLOOR RIGID_BODY fx)" -1 1e-9
near 'floor: moment' "$(resultant floor FLOOR RIGID_BODY moment)" 10 1e-8
near 'floor: the largest pressure' "$(extreme floor contact_pressure value)" "$(summary floor max_pressure)" 0
near 'floor: the largest shear' "$(extreme floor contact_shear value)" "$(summary floor max_abs_shear)" 0
in_balance floor 1e-9
floor >punch.inp <<DECK
*NODE, NSET=HANDLE
900, 7, 3
*SURFACE, NAME=PUNCH, TYPE=SEGMENTS
START, 2.5, 2
LINE, 1, 2
*RIGID BODY, ANALYTICAL SURFACE=PUNCH, REF NODE=900
*CONTACT PAIR, INTERACTION=JOINT
BLOCK-TOP, PUNCH
*STEP
*STATIC
*DLOAD
, BY, -1.
*BOUNDARY
HANDLE, 1
HANDLE, 2, 2, -0.01
HANDLE, 6
*NODE PRINT
U
*END STEP
DECK
run 0 punch.inp punch --digits 17 --quiet
near 'punch: force of the handle' "$(resultant punch HANDLE BOUNDARY fy)" "$(column punch/rigid.tab r2)" 1e-12
near 'punch: weight of all elements' "$(resultant punch all_elements DLOAD fy)" -6 1e-12
near 'punch: moment about the origin' "$(resultant punch HANDLE BOUNDARY moment)" \
   "$(value "$(column punch/rigid.tab moment) + 7*$(column punch/rigid.tab r2) - 3*$(column punch/rigid.tab r1)")" 1e-9
[ -z "$(resultant punch PUNCH RIGID_BODY fy)" ] || complain 'punch: what its node holds is told twice'
in_balance punch 1e-9
near 'punch: the reference node displaces nothing' "$(extreme punch u2_min x)" "$(awk '!/^#/ && $2 != 900 && (n++ == 0 || $6 < m - 1e-12) {
   m = $6; x = $3 } END { print x }' punch/nodes.tab)" 0

# an inclined roller, and the examples of the paper
sed 's/^FOOT, 2$/FOOT, 2\n*TRANSFORM, NSET=SLOPE\n1., 1., 0., -1., 1., 0.\n*NSET, NSET=SLOPE\n21\n*BOUNDARY\nSLOPE, 2/' bar.inp >slope.inp
run 0 slope.inp slope --digits 17 --quiet
near 'slope: the force is along its normal' \
   "$(value "$(resultant slope SLOPE BOUNDARY fx) + $(resultant slope SLOPE BOUNDARY fy)")" 0 1e-10
in_balance slope 1e-11
for example in ex1-plate-on-support ex1-plate-on-rigid-support ex2-two-plates ex3-pillar-in-ground; do
   sed 's/^\*END STEP/*EL PRINT, POSITION=AVERAGED AT NODES\nS\n*END STEP/' "$input/$example.inp" >$example.inp
   run 0 $example.inp $example --digits 17 --quiet
   in_balance $example 1e-9
   near "$example: mises" "$(extreme $example mises value)" "$(column $example/nodal_stress.tab mises | sort -g | tail -n 1)" 1e-8
   near "$example: u2 min" "$(extreme $example u2_min value)" "$(column $example/nodes.tab u2 | sort -g | head -n 1)" 1e-10
   near "$example: s11 of the field file's nodes" "$(grep -vc '^#' $example/nodal_stress.tab)" "$(grep -vc '^#' $example/nodes.tab)" 0
done

# compare: a value counts, a place does not
for table in extremes resultants nodal_stress; do
   rm -rf copy
   cp -r bar copy
   for k in 3 4; do
      awk -v k=$k '/^#/ || changed { print; next } $k + 0 != 0 { $k = $k*1.1; changed = 1 } { print } END { exit !changed }' \
         bar/$table.tab >copy/$table.tab || continue
      "$atrito" compare bar copy >compare.out
      code=$?
      wanted=1
      [ $table$k = extremes4 ] && wanted=0
      [ $code -eq $wanted ] || complain "compare: $table, column $k: exit $code"
   done
   rm copy/$table.tab
   if "$atrito" compare bar copy >compare.out; then complain "compare: $table is missing"; fi
done
finish
