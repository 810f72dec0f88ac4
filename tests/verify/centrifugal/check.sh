# check.sh ATRITO CASE_FOLDER INPUT_FOLDER
. "$(dirname "$0")/../lib.sh"

# deck TYPE SET BLOCK CENTRIF: a block with its corners BLOCK, E = 2000, rho = 3, thickness 0.5.
deck() {
   printf '%s\n' "*BLOCK, TYPE=$1, ELSET=C, NX=4, NY=2" "$3" '*MATERIAL, NAME=M' '*ELASTIC' "2000, ${mu:-0.3}" '*DENSITY' 3 \
      '*SOLID SECTION, ELSET=C, MATERIAL=M' 0.5 '*BOUNDARY' "$2" '*STEP' '*STATIC' '*DLOAD' "C, CENTRIF, $4" '*NODE PRINT' 'U, RF' '*END STEP'
}

# rho w^2 L^3/(3 E) = 3*4*8/6000
for type in CPS8 CPS9 CPE8 CPE9 CPS8R; do
   mu=0 deck $type 'C-LEFT, 1, 2' '0, 0
2, 0
2, 0.5
0, 0.5' '4, 0, 7, 0, 0, 2, 0' >bar.inp
   run 0 bar.inp bar-$type --digits 17 --quiet
   near "$type, bar, end" "$(awk '!/^#/ && $3 == 2 && $4 == 0 { print $5 }' bar-$type/nodes.tab)" "$(value '3*4*8/(3*2000)')" 1e-13
done

# the hollow cylinder 1 < r < 2 in plane strain: E' = E/(1 - mu^2), m = mu/(1 - mu)
lame='3*4*(3 + m)*(1 - m)/(8*e)*r*(1 + 4 + (1 + m)/(1 - m)*4/r^2 - (1 + m)/(3 + m)*r^2)'
of_radius() { awk -v r="$1" "BEGIN { m = 0.3/0.7; e = 2000/(1 - 0.09); printf \"%.17g\", $lame }"; }
for type in CAX3 CAX4 CAX4R CAX6 CAX8 CAX8R CAX9; do
   deck $type 'C-BOTTOM, 2
C-TOP, 2' '1, 0
2, 0
2, 1
1, 1' '4, 0, 5, 0, 0, 1, 0' >ring.inp
   run 0 ring.inp ring-$type --refine 2 --digits 17 --quiet
   tolerance=2e-6
   case $type in CAX3|CAX4|CAX4R) tolerance=2e-3 ;; esac
   near "$type, inner radius" "$(awk '!/^#/ && $3 == 1 && $4 == 0 { print $5 }' ring-$type/nodes.tab)" "$(of_radius 1)" $tolerance
   near "$type, outer radius" "$(awk '!/^#/ && $3 == 2 && $4 == 0 { print $5 }' ring-$type/nodes.tab)" "$(of_radius 2)" $tolerance
done
says 'the thickness of a ring has no effect' ring-CAX8/ring.lst 'N-THICKNESS'
deck CPE9 'C-BOTTOM, 2
C-TOP, 1' '1, 0
2, 0
0, 2
0, 1' '4, 0, 0, 3, 0, 0, -2' | sed 's/^0, 1$/&\nARC, RIGHT, 0, 0\nARC, LEFT, 0, 0/' >quarter.inp
run 0 quarter.inp quarter --refine 1 --digits 17 --quiet
near 'quarter, inner radius' "$(awk '!/^#/ && $3 == 1 { print $5 }' quarter/nodes.tab)" "$(of_radius 1)" 1e-4
near 'quarter, outer radius' "$(awk '!/^#/ && $3 == 2 { print $5 }' quarter/nodes.tab)" "$(of_radius 2)" 1e-4

# A block 1 < x < 3, 1 < y < 2 of mass 3: w^2 = 4. About z through (0.5, -1): the way of the centroid is (1.5, 2.5). About (3, 4) in the
# plane through (0, 1): n = (-4, 3)/5, n.(x - x0) of the centroid (2, 1.5) is -1.3.
sum_of() { awk -v dof="$2" '!/^#/ { s -= $(dof + 2) } END { printf "%.17g", s }' "$1/reactions.tab"; }
for type in CPE3 CPE4 CPE6 CPE8 CPE9 CPE4R CPE8R CPS4; do
   for axis in across askew; do
      at='0.5, -1, 9, 0, 0, 1'; f1=18; f2=30; moment=33
      [ $axis = askew ] && { at='0, 1, 0, 30, 40, 0'; f1=12.48; f2=-9.36; moment=-38.88; }
      deck $type 'C-LEFT, 1, 2' '1, 1
3, 1
3, 2
1, 2' "4, $at" >block.inp
      run 0 block.inp block --digits 17 --quiet
      near "$type, $axis, reactions along x" "$(sum_of block 1)" $f1 1e-12
      near "$type, $axis, reactions along y" "$(sum_of block 2)" $f2 1e-12
      set -- $(awk '/force per volume|body forces|in elements/ { print $(NF - 2), $(NF - 1), $NF; exit }' block/block.lst) none none none
      near "$type, $axis, listing, along x" "$1" $f1 1e-4
      near "$type, $axis, listing, along y" "$2" $f2 1e-4
      near "$type, $axis, listing, moment" "$3" $moment 1e-4
   done
done

# Steps. One step of half the load; a history of two increments, with and without an amplitude; then another axis; then none.
one() { deck CPE8 'C-LEFT, 1, 2' '1, 1
3, 1
3, 2
1, 2' "$1"; }
one '2, 0.5, -1, 0, 0, 0, 1' >half.inp
one '3, 0, 1, 0, 30, 40, 0' >other.inp
run 0 half.inp half --digits 17 --quiet
run 0 other.inp other --digits 17 --quiet
one '4, 0.5, -1, 0, 0, 0, 1' | sed 's/^\*STEP/*AMPLITUDE, NAME=A\n0, 0, 1, 0.5\n&/' >steps.inp
printf '%s\n' '*STEP' '*STATIC' '0.5, 1' '*DLOAD' 'C, CENTRIF, 3, 0, 1, 0, 30, 40, 0' '*NODE PRINT, FREQUENCY=1' U '*END STEP' \
   '*STEP' '*STATIC' '*DLOAD, OP=NEW' '*NODE PRINT' U '*END STEP' >>steps.inp
awk '/^\*DLOAD$/ && !n++ { print "*DLOAD, AMPLITUDE=A"; next } { print }' steps.inp >curve.inp
run 0 steps.inp steps --digits 17 --quiet
run 0 curve.inp curve --digits 17 --quiet
# frame FOLDER K: u of the K-th printed increment
frame() { awk -v k="$2" '/^#/ { print; next } $2 + 0 <= last + 0 { n++ } { last = $2 } n == k - 1 { print }' "$1/nodes.tab"; }
for folder in steps curve; do
   for k in 1 2 3 4; do frame $folder $k >$folder-$k.tab; done
done
end() { awk '!/^#/ && $3 == 3 && $4 == 2 { print $5 }' "$1"; }
near 'the amplitude halves it' "$(end curve-1.tab)" "$(end half/nodes.tab)" 1e-14
near 'the whole load' "$(end steps-1.tab)" "$(value "2*$(end half/nodes.tab)")" 1e-14
near 'half way to the other axis' "$(end steps-2.tab)" "$(value "$(end half/nodes.tab) + $(end other/nodes.tab)/2")" 1e-14
near 'half way from the half' "$(end curve-2.tab)" "$(value "($(end half/nodes.tab) + $(end other/nodes.tab))/2")" 1e-14
near 'the other axis' "$(end steps-3.tab)" "$(end other/nodes.tab)" 1e-14
near 'the other axis behind an amplitude' "$(end curve-3.tab)" "$(end other/nodes.tab)" 1e-14
near 'none' "$(end steps-4.tab)" 0 1e-16

# CalculiX prints 7 digits
run 0 "$here/askew.inp" askew --digits 17 --quiet
tail -n +4 "$here/askew.ccx" >expected.dat
awk 'NR == FNR { if (NF == 4) { u[$1] = $2; v[$1] = $3; for (i = 2; i < 4; i++) if ($i^2 > most^2) most = $i }; next }
   !/^#/ { d = ($5 - u[$2])^2 + ($6 - v[$2])^2; if (d > worst) worst = d; n++ }
   END { if (n != 13) worst = 1; printf "%.3e\n", sqrt(worst)/(most < 0 ? -most : most) }' expected.dat askew/nodes.tab >off.txt
below 'askew, against CalculiX' "$(cat off.txt)" 1e-6
finish
