#!/bin/sh
# A body that nothing holds but friction, without load: it stays where it is.
. "$(dirname "$0")/../lib.sh"

# at FOLDER TABLE COLUMN STEP INCREMENT [NODE]: largest size, or the number of a node.
at() {
   awk -v name="$3" -v step="$4" -v increment="$5" -v node="${6:-0}" '
      /^# columns:/ { for (i = 3; i <= NF; i++) at[$i] = i - 2 }
      !/^#/ && $1 == step && $at["increment"] == increment && (node == 0 || $2 == node) {
         n++; v = $at[name] + 0; if (!node && v < 0) v = -v; if (n == 1 || v > most) most = v }
      END { if (n) printf "%.17g\n", most; else print "none" }' "$1/$2.tab"
}

for form in dense sparse; do
   run 0 "$here/block.inp" "$form" --digits 17 --contact $form --quiet
   near "$form: given anew by OP=NEW, half of the way" "$(at "$form" nodes u1 3 2 1)" 0.045 1e-14
   near "$form: normal force without load" "$(at "$form" history normal_resultant 5 4)" 0 0
   near "$form: where the block is without load" "$(at "$form" nodes u1 5 4 5)" "$(at "$form" nodes u1 5 3 5)" 2e-3
   near "$form: pressed again" "$(at "$form" history normal_resultant 6 4)" 10 1e-11
   near "$form: friction of the block pressed again" "$(at "$form" history shear_resultant 6 4)" 0 1e-11
   near "$form: dissipation after the drag" "$(at "$form" history dissipation 6 4)" "$(at "$form" history dissipation 5 4)" 1e-12
   # a taper locks itself where friction is more than its slope: the load off, shear is that part of the pressure; else it lets go
   run 0 "$here/taper.inp" "taper-$form" --digits 17 --contact $form --quiet
   near "$form: shear over pressure of the taper" "$(value "$(at "taper-$form" history shear_resultant 2 4)/$(at "taper-$form" history normal_resultant 2 4)")" \
      0.17632698070846498 1e-8
   run 0 "$here/taper.inp" "smooth-$form" --digits 17 --contact $form --quiet --set nu=0.15
   near "$form: the smoother taper lets go" "$(at "smooth-$form" history normal_resultant 2 4)" 0 0
done
finish
