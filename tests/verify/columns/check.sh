. "$(dirname "$0")/../lib.sh"

# The sideways loads are 0.002 of the weights: that their sums are right to 1e-10 needs forces to 1e-13, more than the tolerance that
# is taken when none is given.
# column_of FILE N NX NY: N blocks of 2 x 1 on a rigid floor; weight 0.3, sideways 0.0006 per volume, thickness 0.5.
column_of() {
   awk -v n="$2" -v nx="$3" -v ny="$4" 'BEGIN {
      for (i = 1; i <= n; i++) printf "*BLOCK, TYPE=CPE4, ELSET=B%d, NX=%d, NY=%d\n0, %d\n2, %d\n2, %d\n0, %d\n", i, nx, ny, i - 1, i - 1, i, i
      printf "*MATERIAL, NAME=M\n*ELASTIC\n1e5, 0.2\n"
      for (i = 1; i <= n; i++) printf "*SOLID SECTION, ELSET=B%d, MATERIAL=M\n0.5\n", i
      printf "*SURFACE, NAME=FLOOR, TYPE=SEGMENTS\nSTART, -1, 0\nLINE, 3, 0\n*RIGID BODY, ANALYTICAL SURFACE=FLOOR\n"
      printf "*SURFACE INTERACTION, NAME=I\n*FRICTION\n0.7\n*CONTACT PAIR, INTERACTION=I\nB1-BOTTOM, FLOOR\n"
      for (i = 2; i <= n; i++) printf "B%d-BOTTOM, B%d-TOP\n", i, i - 1
      printf "*STEP\n*STATIC\n*CONTROLS, TOLERANCE=1e-14\n*DLOAD\n"
      for (i = 1; i <= n; i++) printf "B%d, BX, 0.0006\nB%d, BY, -0.3\n", i, i
      printf "*NODE PRINT\nU\n*CONTACT PRINT\n*END STEP\n" }' </dev/null >"$1"
}

# statics WHAT FOLDER N: the worst errors of the resultants over those of the joint, and of their places over the width.
statics() {
   awk -v n="$3" '
      function abs(x) { return x < 0 ? -x : x }
      function take(k, error) { if (abs(error) > worst[k]) worst[k] = abs(error); seen[k]++ }
      !/^#/ && $2 > 0 {
         above = n + 1 - $2
         # a block: volume 2 x 1 x 0.5; the forces act half of the height above the joint
         if ($3 == "normal_resultant") take(1, $4/(0.3*above) - 1)
         if ($3 == "shear_resultant") take(2, $4/(0.0006*above) + 1)
         if ($3 == "resultant_from_start") take(3, ($4 - (1 + 0.002*above/2))/2)
         if ($3 == "slip_points" && $4 > 0) take(4, $4) }
      END { for (k = 1; k <= 3; k++) printf "%s ", seen[k] == n ? sprintf("%.3e", worst[k]) : "none"; printf "%d\n", seen[4] }' \
      "$2/summary.tab" >statics.txt
   read -r normal shear place slipping <statics.txt
   below "$1: weight above" "$normal" 1e-10
   below "$1: sideways load above" "$shear" 1e-10
   below "$1: place of the resultant" "$place" 1e-10
   near "$1: joints with slip" "$slipping" 0 0
}

column_of column.inp 200 1 1
for form in dense sparse; do
   run 0 column.inp column-$form --contact $form --digits 17 --quiet
   statics "column, $form" column-$form 200
done
# without being asked for a form
run 0 column.inp column --digits 17 --quiet
statics column column 200
# seconds: 0.4 here; more than 100 pairs once took all memory
below 'memory in MiB' "$(awk '/^# peak memory/ { print $NF/2^20 }' column/timing.tab)" 120
finish
