#!/bin/sh
# Overlaps that are resolved over a step; README.md has what is asserted.
. "$(dirname "$0")/../lib.sh"

# at NAME STEP INCREMENT COLUMN: of history.tab
at() {
   awk -v step="$2" -v increment="$3" -v name="$4" '/^# columns:/ { for (i = 3; i <= NF; i++) at[$i] = i - 2 }
      !/^#/ && $1 == step && $2 == increment { print $at[name]; n++ } END { if (!n) print "none" }' "$1/history.tab"
}
# last NAME COLUMN [STEP]: a column of contact.tab at the end of the last step, or of another one
last() {
   awk -v name="$2" -v step="${3:-0}" '/^# columns:/ { for (i = 3; i <= NF; i++) at[$i] = i - 2 }
      !/^#/ { if (!step) { if ($1 != now || $at["increment"] != part) { n = 0; now = $1; part = $at["increment"] } } else if ($1 != step) next
              list[++n] = $at[name] }
      END { for (i = 1; i <= n; i++) print list[i] }' "$1/contact.tab"
}
# off A B: largest difference of two columns over the largest number of the second
off() {
   paste "$1" "$2" | awk 'function size(x) { return x < 0 ? -x : x }
      NF != 2 { bad = 1 } { if (size($1 - $2) > d) d = size($1 - $2); if (size($2) > most) most = size($2) }
      END { if (bad || !(most > 0)) print "none"; else printf "%.17g", d/most }'
}

# 1. rings
sed -e '/^\*CONTACT INTERFERENCE/,+1d' -e '/^0.25, 1$/d' -e 's/, FREQUENCY=1//' "$here/shrink.inp" >once.inp
sed 's/^\*STEP$/*STEP\n*STATIC\n*END STEP\n&/' "$here/shrink.inp" >second.inp
run 0 once.inp once --digits 17 --quiet
last once pressure >once.pressure
for form in dense sparse; do
   run 0 "$here/shrink.inp" "shrink-$form" --digits 17 --quiet --contact $form
   last "shrink-$form" pressure >end.pressure
   near "$form: the end" "$(off end.pressure once.pressure)" 0 1e-10
   for k in 1 2 3; do
      near "$form: increment $k" "$(at "shrink-$form" 1 $k normal_resultant)" "$(value "0.25*$k*$(at "shrink-$form" 1 4 normal_resultant)")" 1e-12
      awk -v k=$k '/^# columns:/ { for (i = 3; i <= NF; i++) at[$i] = i - 2 } !/^#/ && $at["increment"] == k { print $at["gap"] + 1e-3*(1 - k/4) }' \
         "shrink-$form/contact.tab" >gaps
      [ "$(wc -l <gaps)" -eq 21 ] || complain "$form, increment $k: points"
      awk '$1 > 1e-15 || $1 < -1e-15 { exit 1 }' gaps || complain "$form, increment $k: gaps"
   done
done
# Lame: both rings in plane strain
lame=$(awk 'function u(e, mu, a, b, inside, outside, r,   k) {
      e = e/(1 - mu*mu); mu = mu/(1 - mu); k = b*b - a*a
      return ((1 - mu)*(inside*a*a - outside*b*b)*r + (1 + mu)*(inside - outside)*a*a*b*b/r)/(e*k) }
   BEGIN { printf "%.17g", 1e-3/(u(2000, 0.2, 1.5, 2, 1, 0, 1.5) - u(1000, 0.3, 1, 1.5, 0, 1, 1.5)) }' </dev/null)
near 'mean pressure of Lame' "$(value "$(at shrink-dense 1 4 normal_resultant)/(0.75*atan2(0, -1))")" "$lame" "$(value "0.01*$lame")"
run 0 second.inp second --digits 17 --quiet
near 'before the step: no pressure' "$(at second 1 1 max_pressure)" 0 1e-15
last second pressure >end.pressure
near 'the second step' "$(off end.pressure once.pressure)" 0 1e-10
"$atrito" check second.inp >second.check 2>second.notes || complain 'check'
says 'check: before' second.check 'up to 0.001 [L], allowed'
says 'check: in the step' second.check 'up to 0.001 [L], resolved over the step'
awk 'length($0) > 80 { exit 1 }' second.check || complain 'check: more than 80 columns'

# 2. friction with memory
for form in dense sparse; do
   run 0 "$here/memory.inp" "memory-$form" --digits 17 --quiet --contact $form
done
for name in pressure shear gap slip; do
   last memory-dense $name >dense.column
   last memory-sparse $name >sparse.column
   [ $name = gap ] || near "dense and sparse: $name" "$(off dense.column sparse.column)" 0 1e-9
done
sed -e 's/VALUE=-2e-3/VALUE=0/' -e '/^\*CONTACT INTERFERENCE/,+1d' "$here/memory.inp" >none.inp
run 0 none.inp none --digits 17 --quiet
for name in pressure shear slip; do
   last none $name 2 >none.column
   last memory-dense $name 2 >dense.column
   near "allowed: $name" "$(off dense.column none.column)" 0 1e-11
done
pushed=$(at memory-dense 2 5 shear_resultant)
near 'the shear of the push stays' "$(at memory-dense 3 1 shear_resultant)" "$pushed" "$(value "-2e-3*($pushed)")"
sed 's/^\*FRICTION/&, SLIP=TOTAL/' "$here/memory.inp" >total.inp
run 0 total.inp total --digits 17 --quiet
below 'the total law has another' 1e-3 "$(value "($(at memory-dense 3 1 shear_resultant) - $(at total 3 1 shear_resultant))/($pushed)")"
# the overlap alone: in proportion to it
awk '/^\*STEP/ { exit } { print }' "$here/memory.inp" >alone.inp
printf '*STEP\n*STATIC\n0.2, 1\n*BOUNDARY\nUP-TOP, 1, 2\n*CONTACT INTERFERENCE, SHRINK\nUP-BOTTOM, LOW-TOP\n*CONTACT PRINT\n*END STEP\n' >>alone.inp
sed -e '/^\*CONTACT INTERFERENCE/,+1d' -e '/^0.2, 1$/d' alone.inp >at-once.inp
for name in alone at-once; do
   run 0 $name.inp $name --digits 17 --quiet
done
for name in pressure shear; do
   last alone $name >alone.column
   last at-once $name >once.column
   near "friction, alone: $name" "$(off alone.column once.column)" 0 1e-9
done

# 3. a clearance by a table: a finer mesh has what the deck's faces interpolate
# table TYPE NX LAST: a block on a floor, the gap x^2/10 at every quarter, between them along straight lines; nodes 1 to LAST below
table() {
   awk -v type="$1" -v nx="$2" -v last="$3" 'BEGIN {
      print "*BLOCK, TYPE=" type ", ELSET=B, NX=" nx ", NY=4\n-1, 0\n1, 0\n1, 1\n-1, 1\n*MATERIAL, NAME=M\n*ELASTIC\n1000, 0.3"
      print "*SOLID SECTION, ELSET=B, MATERIAL=M\n*SURFACE, NAME=FLOOR, TYPE=SEGMENTS\nSTART, -2, 0\nLINE, 2, 0"
      print "*RIGID BODY, ANALYTICAL SURFACE=FLOOR\n*SURFACE INTERACTION, NAME=I\n*CONTACT PAIR, INTERACTION=I\nB-BOTTOM, FLOOR"
      print "*CLEARANCE, SLAVE=B-BOTTOM, MASTER=FLOOR, TABULAR"
      for (i = 0; i < last; i++) {
         x = 8*i/(last - 1); k = x == 8 ? 7 : int(x)
         printf "%d, %.17g\n", i + 1, ((k/4 - 1)^2 + (x - k)*((k + 1)/4 - 1)^2 - (x - k)*(k/4 - 1)^2)/10
      }
      print "*STEP\n*BOUNDARY\nB-TOP, 1\nB-TOP, 2, 2, -0.01\n*CONTACT PRINT\n*END STEP" }' </dev/null
}
table CPE4 8 9 >coarse.inp
table CPE4 16 17 | sed 's/NY=4/NY=8/' >fine.inp
table CPE9 8 17 >nine.inp
run 0 coarse.inp refined --digits 17 --quiet --refine 1
run 0 fine.inp fine --digits 17 --quiet
run 0 nine.inp nine --digits 17 --quiet
"$atrito" study coarse.inp --levels 1 --elements CPE9 --digits 17 -o study >study.out || complain 'study of nine-node elements'
last refined pressure >found.pressure
last fine pressure >expected.pressure
near 'a table, refined' "$(off found.pressure expected.pressure)" 0 1e-10
near 'a table, nine nodes' "$(summary study/cpe9_0 strain_energy)" "$(summary nine strain_energy)" 1e-12
finish
