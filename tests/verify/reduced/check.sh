. "$(dirname "$0")/../lib.sh"

# the same element in CalculiX (CPE8R): 69 nodes, printed with 7 digits
sed 's/TYPE=CPE8/TYPE=CPE8R/' "$here/../eight-nodes/beam.inp" >beam.inp
run 0 beam.inp beam --digits 17 --quiet
below 'largest difference from CalculiX, of the largest displacement' "$(awk '
   function size(v) { return v < 0 ? -v : v }
   NR == FNR { a[$1] = $2; b[$1] = $3; if (size($3) > most) most = size($3); next }
   !/^#/ && ($2 in a) { n++; d = size($5 - a[$2]); e = size($6 - b[$2]); if (e > d) d = e; if (d > worst) worst = d }
   END { if (n == 69) printf "%.17g", worst/most; else print "none" }' "$here/beam.ccx" beam/nodes.tab)" 1e-6

# bent NAME TYPE MU M TOLERANCE: pure bending at the nodes, along the axes and turned.
bent() {
   sed "s/TYPE=CPS4R/TYPE=$2/" "$here/bent.inp" >"$1.inp"
   for angle in 0 30; do
      run 0 "$1.inp" "$1-$angle" --set angle=$angle --set mu="$3" --set m="$4" --digits 17 --quiet
      c=$(value "cos($angle*atan2(0, -1)/180)"); s=$(value "sin($angle*atan2(0, -1)/180)")
      along="($c*x + $s*y)"; across="($c*y - $s*x - 0.5)"
      field_near "$1, $angle degrees" "$1-$angle/nodes.tab" u1 \
         "-$c*1e-3*$along*$across - $s*5e-4*($along^2 + $4*$across^2)" "$5"
      field_near "$1, $angle degrees" "$1-$angle/nodes.tab" u2 \
         "-$s*1e-3*$along*$across + $c*5e-4*($along^2 + $4*$across^2)" "$5"
   done
}
bent thin CPS4R 0.3 0.3 1e-15
bent thin-eight CPS8R 0.3 0.3 1e-15
bent thick CPE4R 0.3 "$(value 3/7)" 1e-15
bent thick-eight CPE8R 0.3 "$(value 3/7)" 1e-15
# lambda is 5,000 times G there, and so is the condition
bent incompressible CPE4R 0.4999 "$(value 0.4999/0.5001)" 1e-13
# the full integration of four nodes is too stiff for that
sed 's/TYPE=CPS4R/TYPE=CPS4/' "$here/bent.inp" >stiff.inp
run 0 stiff.inp stiff --digits 17 --quiet
[ "$(grep -vc '^#' thin-0/stress.tab)" -eq 8 ] || complain 'not one point an element of four nodes'
[ "$(grep -vc '^#' thin-eight-0/stress.tab)" -eq 32 ] || complain 'not four points an element of eight nodes'
field_near 'stress at the middles' thin-0/stress.tab s11 '-(y - 0.5)' 1e-11
field_near 'stress at 2 x 2 points' thin-eight-0/stress.tab s11 '-(y - 0.5)' 1e-11
below 'estimated error of eight nodes in %' "$(summary thin-eight-0 error_estimate_percent)" 1e-8
# in bending the stress varies within four nodes, and the estimate tells it: s11 of two rows is +-1/4 where it goes to 1/2
near 'estimated error of four nodes in %' "$(summary thin-0 error_estimate_percent)" 50 1

for level in 0 1 2; do
   run 0 "$here/mixed.inp" "mixed-$level" --refine $level --digits 17 --quiet
   field_near "mixed, level $level" "mixed-$level/nodes.tab" u1 '1e-3*x + 2e-3*y' 1e-15
   field_near "mixed, level $level" "mixed-$level/nodes.tab" u2 '3e-3*y - 1e-3*x' 1e-15
   all_near "mixed, level $level" "mixed-$level/stress.tab" s12 0.4 1e-12
   all_near "mixed, level $level" "mixed-$level/stress.tab" s22 4 1e-11
   below "mixed, level $level, estimated error in %" "$(summary "mixed-$level" error_estimate_percent)" 1e-8
done
says 'kinds in the listing' mixed-0/mixed.lst '(2 CPE4, 2 CPE4R)'

# contact: sides that do not match, either integration
for type in CPE4R CPE8R; do
   sed "s/TYPE=CPE4/TYPE=$type/" "$input/lessons/nonmatching.inp" >"contact-$type.inp"
   run 0 "contact-$type.inp" "contact-$type" --digits 17 --quiet
   all_near "contact, $type" "contact-$type/stress.tab" s22 -10 1e-10
done

# a study takes another integration of the same elements
sed 's/TYPE=CPS4R/TYPE=CPS4/' "$here/bent.inp" >full.inp
"$atrito" study full.inp --levels 1 --elements cps4,cps4r -o study --digits 17 --quiet 2>told || complain 'study of reduced integration'
near 'strain energy, full' "$(summary study/cps4_0 strain_energy)" "$(summary stiff strain_energy)" 1e-15
near 'strain energy, reduced' "$(summary study/cps4r_0 strain_energy)" "$(summary thin-0 strain_energy)" 1e-15
near 'the two differ' "$(awk -v a="$(summary study/cps4_0 strain_energy)" -v b="$(summary study/cps4r_0 strain_energy)" \
   'BEGIN { print (a > 1.05*b) + 0 }' </dev/null)" 1 0

# A cantilever 10 x 1, E = 1000, mu = 0.3, end force 0.01 by a traction: F l^3/(3 E I) + 6/5 F l/(G A), Timoshenko's beam.
for rows in 1 2 4; do
   cat >beam-$rows.inp <<deck
*HEADING
Cantilever
*BLOCK, TYPE=CPS4R, ELSET=B, NX=$((10*rows)), NY=$rows
0, 0
10, 0
10, 1
0, 1
*MATERIAL, NAME=M
*ELASTIC
1000, 0.3
*SOLID SECTION, ELSET=B, MATERIAL=M
1
*STEP
*STATIC
*BOUNDARY
B-LEFT, 1
1, 2
*DSLOAD
B-RIGHT, TRVEC, 0.01, 0, -1
*NODE PRINT
U
*END STEP
deck
   run 0 beam-$rows.inp beam-$rows --digits 17 --quiet
   near "tip of the cantilever, $rows rows" "$(awk '!/^#/ && $3 == 10 { u += $6; n++ } END { printf "%.17g", u/n }' \
      beam-$rows/nodes.tab)" "$(value '-(0.01*1000*12/3000 + 1.2*0.1*2.6/1000)')" 4e-4
done

# Hourglasses of eight nodes: one element whose supports leave it, at any place, size and angle and with every solver; a row of thin
# elements that takes it; none in beams, in rows of squares, or where the supports hold it.
row() { # NAME TYPE ELEMENTS LENGTH ANGLE UNIT SUPPORTS
   awk -v type="$2" -v n="$3" -v l="$4" -v angle="$5" -v unit="$6" -v held="$7" 'function point(x, y) {
         return sprintf("%.17g, %.17g", unit*(7 + c*x - s*y), unit*(s*x + c*y)) }
      BEGIN { c = cos(angle*atan2(0, -1)/180); s = sin(angle*atan2(0, -1)/180)
         print "*BLOCK, TYPE=" type ", ELSET=B, NX=" n ", NY=1\n" point(0, 0) "\n" point(l, 0) "\n" point(l, 1) "\n" point(0, 1)
         print "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*SOLID SECTION, ELSET=B, MATERIAL=M\n*BOUNDARY"
         k = split(held, line, "/"); for (i = 1; i <= k; i++) print line[i]
         print "*STEP\n*STATIC\n*DSLOAD\nB-TOP, P, 1.\n*NODE PRINT\nU\n*END STEP" }' </dev/null >"$1.inp"
}
for type in CPE8R CPS8R CAX8R; do
   few='1, 1, 2/2, 2'
   [ $type = CAX8R ] && few='2, 2'
   for solver in skyline banded sparse; do
      row alone $type 1 1 30 1 "$few"
      run 4 alone.inp alone --quiet --solver $solver
      says "alone, $type, $solver" alone.err 'element 1 can take a shape that strains none of its points, an hourglass'
   done
   row alone $type 1 100 57.3 1e-3 "$few"
   run 4 alone.inp alone --quiet
   says "alone and slender, $type" alone.err 'an hourglass of reduced integration'
   row held $type 1 1 0 1 'B-BOTTOM, 2/1, 1'
   run 0 held.inp held --quiet --contact sparse
   row thin $type 10 0.5 30 1 "$few"
   run 0 thin.inp thin --quiet
   says "thin, $type" thin.err '[W-HOURGLASS] body B: elements in one row take the shape that reduced integration hardly feels'
   row full "${type%R}" 10 0.5 30 1 "$few"
   run 0 full.inp full --quiet
   for length in 5 50; do
      row beam $type 5 $length 0 1 'B-LEFT, 1, 2'
      run 0 beam.inp beam --quiet
      cat beam.err >>quiet.err
   done
done
cat held.err full.err quiet.err | grep -q HOURGLASS && complain 'an hourglass that is none'
finish
