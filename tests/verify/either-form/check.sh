#!/bin/sh
# What one form of the contact system solves the other does as well, with the same displacements.
. "$(dirname "$0")/../lib.sh"

for name in three-blocks corner taken-back; do
   for form in dense sparse; do
      run 0 "$here/$name.inp" "$name-$form" --digits 17 --contact $form --quiet
   done
   none=0
   [ $name = corner ] && none=1e-11   # of a height of 253: no Poisson's ratio, no displacement to the side
   "$atrito" compare "$name-dense/nodes.tab" "$name-sparse/nodes.tab" --rtol 1e-8 --atol "$none" >"$name.cmp" || {
      complain "$name: forms differ"
      cat "$name.cmp"
   }
done

# The corner: 68030.76 of pressure on a side of 492.438 by 3; the floor bears it less what sticks to the wall.
for form in dense sparse; do
   near "corner, $form: floor and wall bear the load" "$(awk '!/^#/ && $2 == 2 && $3 == "normal_resultant" { a = $4 }
      !/^#/ && $2 == 1 && $3 == "shear_resultant" { s = $4 } END { printf "%.17g", a + (s < 0 ? -s : s) }' "corner-$form/summary.tab")" \
      "$(value "68030.76068406359*492.43800637479444*3")" 1e-3
   # nothing acts at the end: nothing is left
   near "taken back, $form: what is left" "$(awk '
      !/^#/ && $1 == 3 { if ($7 != last) m = 0; last = $7; for (i = 5; i <= 6; i++) { v = $i < 0 ? -$i : $i; if (v > m) m = v } }
      END { printf "%.17g", m + 0 }' "taken-back-$form/nodes.tab")" 0 0
done
finish
