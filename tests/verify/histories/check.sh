#!/bin/sh
# Histories of friction against closed forms; README.md has their sources.
. "$(dirname "$0")/../lib.sh"

# cylinders NAME STEPS INTERACTION [SLAVE [DEPTH]]: a deck of cattaneo.awk, run.
cylinders() {
   awk -v type=CPE4 -v n=24 -v interaction="$3" -v slave="${4:-A}" -v depth="${5:-1}" -f "$here/cattaneo.awk" <"$2" >"$1.inp"
   run 0 "$1.inp" "$1" --digits 17 --quiet
}

# tractions NAME STEP INCREMENT TOP BACK: three numbers. The largest difference of the shear from that of Mindlin, loaded to TOP and then to
# BACK (over nu N), over nu p0, but for the points within an element of a kink and of the edge; how far out of place the end of what
# sticks is, in elements; the number of points that were compared.
tractions() {
   awk -v step="$2" -v increment="$3" -v top="$4" -v back="$5" '
      function cattaneo(x, t,    c) {
         c = sqrt(1 - t)
         return (x < 1 ? sqrt(1 - x*x) : 0) - (x < c ? sqrt(c*c - x*x) : 0)
      }
      /^# columns:/ { for (i = 3; i <= NF; i++) at[$i] = i - 2 }
      !/^#/ && $1 == step && $at["increment"] == increment {
         x = $at["x"]/0.3; if (x < 0) x = -x
         there = sqrt(1 - top); here = (back == top) ? there : sqrt(1 - (top - back)/2)
         if ($at["status"] == 1 && x > stuck) stuck = x
         q = -$at["shear"]/(0.3*2*3.8838/(atan2(0, -1)*0.3))
         if (q !~ /^[-+]?[0-9.]+([eE][-+]?[0-9]+)?$/) bad = 1
         h = 1.01/24
         if (x > 1 - h || (x > here - h && x < here + h) || (x > there - h && x < there + h)) next
         n++; d = q - cattaneo(x, top) + 2*cattaneo(x, (top - back)/2); if (d < 0) d = -d; if (d > most) most = d }
      END { d = 24*(stuck - here); if (bad || !n) print "none none 0"; else printf "%.17g %.17g %d", most, (d < 0 ? -d : d), n }' \
      "$1/contact.tab"
}
# mindlin NAME STEP INCREMENT TOP BACK
mindlin() {
   # shellcheck disable=SC2046
   set -- "$@" $(tractions "$@")
   near "$1, step $2, increment $3: shear, off over nu p0" "$6" 0 0.01
   [ "$4" = "$5" ] && first=1 || first=0
   near "$1, step $2, increment $3: end of the stick zone, off in elements" "$7" 0 1
   below "$1, step $2, increment $3: points left out" "$(value "47 - $8")" "$((9 + 4 - 4*first))"
}
# after NAME COLUMN STEP: what the last row of a step has in history.tab.
after() {
   awk -v name="$2" -v step="$3" '/^# columns:/ { for (i = 3; i <= NF; i++) at[$i] = i - 2 }
      !/^#/ && $1 == step { found = $at[name]; n++ } END { print n ? found : "none" }' "$1/history.tab"
}
# dissipation NAME FIRST LAST: from the end of step FIRST to that of step LAST; the column adds up from the beginning.
dissipation() {
   value "$(after "$1" dissipation "$3") - $(after "$1" dissipation "$2")"
}
# of_increment NAME COLUMN STEP INCREMENT: of history.tab.
of_increment() {
   awk -v name="$2" -v step="$3" -v increment="$4" '/^# columns:/ { for (i = 3; i <= NF; i++) at[$i] = i - 2 }
      !/^#/ && $1 == step && $2 == increment { print $at[name] }' "$1/history.tab"
}

# 1. Cattaneo and Mindlin: N, then T = nu N/2, back to 0 and to -T, and to T again
stiffness=$(value '1000/(2*(1 - 0.09))')
unit=$(value "0.09*3.8838*3.8838/$stiffness")
loop=$(value "2/atan2(0, -1)*(0.75 + log(0.5))*$unit")
for slave in A B; do
   cylinders loop-$slave "$here/loop.steps" '*FRICTION/0.3' $slave
   mindlin loop-$slave 2 8 0.5 0.5
   mindlin loop-$slave 3 8 0.5 0
   mindlin loop-$slave 3 16 0.5 -0.5
   mindlin loop-$slave 4 16 0.5 0.5
   near "loop-$slave: dissipation of the first loading" "$(dissipation loop-$slave 1 2)" "$(value "$loop/4")" "$(value "0.01*$loop/4")"
   near "loop-$slave: dissipation of the loop" "$(dissipation loop-$slave 2 4)" "$loop" "$(value "0.01*$loop")"
done
cylinders amplitude "$here/amplitude.steps" '*FRICTION/0.3'
mindlin amplitude 2 8 0.5 0.5
mindlin amplitude 2 16 0.5 0
mindlin amplitude 2 24 0.5 -0.5
mindlin amplitude 2 40 0.5 0.5
near 'amplitude: dissipation' "$(dissipation amplitude 1 2)" "$(dissipation loop-A 1 4)" "$(value "1e-9*$loop")"

# 2. N and T grow together: with slip in increments all sticks, q = T/N p; the total law has Cattaneo's tractions
# ramp NAME INCREMENTS INTERACTION: the half width grows by the same length in each; elements a quarter as high as they are long.
ramp() {
   {
      echo '*AMPLITUDE, NAME=GROWING'
      awk -v n="$2" 'BEGIN { for (k = 0; k <= n; k++) printf "%.12g, %.12g\n", k/n, (k/n)^2 }' </dev/null
      printf '*STEP, INC=1000\n*STATIC\n%s, 1.\n*CLOAD, AMPLITUDE=GROWING\nREF, 2, -3.8838\nREF, 1, 0.58257\n' "$(value "1/$2")"
      printf '*CONTACT PRINT\n*END STEP\n'
   } >"$1.steps"
   cylinders "$1" "$1.steps" "$3" A 4
}
# share NAME REACH: the mean of q/(nu p) over the points within REACH of the middle.
share() {
   awk -v reach="$2" '/^# columns:/ { for (i = 3; i <= NF; i++) at[$i] = i - 2 }
      !/^#/ && $at["x"] <= reach && -$at["x"] <= reach { sum -= $at["shear"]/(0.3*$at["pressure"]); n++ }
      END { if (n) printf "%.17g", sum/n; else print "none" }' "$1/contact.tab"
}
for increments in 30 60 240; do
   ramp together-$increments $increments '*FRICTION/0.3'
done
near 'together, 240 increments: points that slip' "$(after together-240 slip 1)" 0 0
# 1 % of the ratio; q over p is asked for, as all sticks and the mesh has its own p0
near 'together, 240 increments: q(0)/(nu p(0))' "$(share together-240 1e-9)" 0.5 0.005
near 'together, 240 increments: q/(nu p) over half of the contact' "$(share together-240 0.15)" 0.5 0.002
near 'together, 60 increments: q(0)/(nu p(0))' "$(share together-60 1e-9)" 0.5 0.015
near 'together, 30 increments: q(0)/(nu p(0))' "$(share together-30 1e-9)" 0.5 0.025
ramp total 4 '*FRICTION, NONLOCAL/0.3, 0, 0'
near 'together, total slip: q(0)/(nu p(0))' "$(share total 1e-9)" 0.2929 0.003
ramp once 1 '*FRICTION/0.3'
near 'at once: q(0)/(nu p(0))' "$(share once 1e-9)" "$(share total 1e-9)" 1e-9

# 3. A block dragged there and back: F = +-nu N on the plateaus; a closed loop between +-way has the area 4 nu N (way - nu q/k)
for k in 1000 4000; do
   for way in 0.01 0.025; do
      name=drag-$k-$way
      run 0 "$here/drag.inp" "$name" --set k=$k --set way=$way --digits 17 --quiet
      near "$name: plateau there" "$(of_increment "$name" shear_resultant 2 10)" -8 8e-10
      near "$name: plateau back" "$(of_increment "$name" shear_resultant 3 10)" 8 8e-10
      near "$name: dissipation of the loop" "$(dissipation "$name" 2 4)" "$(value "4*8*($way - 4/$k)")" 1e-12
      near "$name: dissipation of the first way" "$(dissipation "$name" 1 2)" "$(value "8*($way - 4/$k)")" 1e-12
   done
done

# 4. Pushed past what friction holds, 2/3 of the second step: increments are cut back to the least, what converged is written
run 4 "$here/too-far.inp" too-far --digits 17 --quiet
says 'too far' too-far/contact.tab 'NOT CONVERGED: ended in step 2'
last=$(column too-far/history.tab time | tail -n 1)
near 'too far: the last time that converged' "$last" "$(value '1 + 2/3')" 2e-4
near 'too far: the shear force there' "$(column too-far/history.tab shear_resultant | tail -n 1)" "$(value "-15*($last - 1)")" 1e-9

# 5. Temperatures that some steps have and others have not
for form in dense sparse; do
   run 0 "$here/heat.inp" "heat-$form" --contact $form --digits 17 --quiet
   # shellcheck disable=SC2016
   field_near "heated in the second step, $form" "heat-$form/nodes.tab" u1 \
      'x*(0.03*($1 == 2 ? $NF/4 : $1 == 3 ? 1 - $NF/2 : 0) - 0.007)' 1e-14
   near "heated in the second step, $form: increments" "$(column "heat-$form/history.tab" time | wc -l)" 9 0
done
finish
