#!/bin/sh
# Rigid surfaces that move in histories; README.md has what is exact.
. "$(dirname "$0")/../lib.sh"

# end FOLDER STEP COLUMN [INCREMENT]: of rigid.tab in the last increment of a step, or in that one.
end() {
   awk -v step="$2" -v name="$3" -v increment="${4:-0}" '/^# columns:/ { for (i = 3; i <= NF; i++) at[$i] = i - 2 }
      !/^#/ && $1 == step && (increment == 0 || $at["increment"] == increment) { found = $at[name]; n++ }
      END { print n ? found : "none" }' "$1/rigid.tab"
}
# work FOLDER: of r1 and r2 in steps 3 and 4, by trapezes.
work() {
   awk '/^# columns:/ { for (i = 3; i <= NF; i++) at[$i] = i - 2; next } /^#/ { next }
      { u = $at["u1"]; v = $at["u2"]; r = $at["r1"]; s = $at["r2"]
        if ($1 >= 3) { w += (r + r0)/2*(u - u0) + (s + s0)/2*(v - v0); n++ } u0 = u; v0 = v; r0 = r; s0 = s }
      END { if (n) printf "%.17g", w; else print "none" }' "$1/rigid.tab"
}
# dissipation FOLDER FIRST LAST: between the ends of two steps.
dissipation() {
   awk -v first="$2" -v last="$3" '/^# columns:/ { for (i = 3; i <= NF; i++) at[$i] = i - 2; next } /^#/ { next }
      $1 == first { a = $at["dissipation"]; n++ } $1 == last { b = $at["dissipation"]; m++ }
      END { if (n && m) printf "%.17g", b - a; else print "none" }' "$1/history.tab"
}
# steps NAME TEXT: push.inp with other steps, lines between slashes.
steps() {
   { sed '/^\*STEP/,$d' "$here/push.inp"; echo "$2" | tr / '\n'; } >"$1.inp"
}
both() { # NAME [options]: both forms, which agree
   name=$1
   deck=$2
   shift 2
   for form in dense sparse; do
      run 0 "$deck" "$name-$form" --digits 17 --contact $form --quiet "$@"
      drop_columns "$name-$form/history.tab" unique_up_to_nu index       # which the condensed form alone proves
   done
   same_tables "$name: rigid.tab of both forms" "$name-dense/rigid.tab" "$name-sparse/rigid.tab" 1e-9
   same_tables "$name: contact.tab of both forms" "$name-dense/contact.tab" "$name-sparse/contact.tab" 1e-9
   same_tables "$name: history.tab of both forms" "$name-dense/history.tab" "$name-sparse/history.tab" 1e-9
}

# 1. There and back by displacement, N by a force
both push "$here/push.inp"
for form in dense sparse; do
   near "push-$form: plateau there" "$(end push-$form 2 r1)" 10 1e-10
   near "push-$form: plateau, 2 increments before" "$(end push-$form 2 r1 8)" 10 1e-10
   near "push-$form: plateau back" "$(end push-$form 3 r1)" -10 1e-10
   near "push-$form: plateau there again" "$(end push-$form 4 r1)" 10 1e-10
   near "push-$form: moment there again" "$(end push-$form 4 moment)" "$(end push-$form 2 moment)" 1e-9
done
near 'push: rows' "$(grep -vc '^#' push-dense/rigid.tab)" 52 0
near 'push: work of the loop' "$(work push-dense)" "$(dissipation push-dense 2 4)" 0.005
sed 's/^0\.05, 1$/0.0125, 1/' "$here/push.inp" >fine.inp
run 0 fine.inp fine --digits 17 --quiet --contact dense
near 'push, quarters: work of the loop' "$(work fine)" "$(dissipation fine 2 4)" 0.0003
grep -Eq '^   PUNCH +-0.016 +-0.016421 +0 +-10 +free +-16.1129$' push-dense/push.lst || complain 'push: listing by frame'
says 'push: listing of steps' push-dense/push.lst 'reference node 1000, rotation = 0, u1 = -0.08'

# 2. One kink on each way
# (at the kink it is open to round-off whether a point sticks or slips, so statuses are not compared)
for form in dense sparse; do run 0 "$here/flat.inp" flat-$form --digits 17 --contact $form --quiet; done
same_tables 'flat: rigid.tab of both forms' flat-dense/rigid.tab flat-sparse/rigid.tab 1e-9
for form in dense sparse; do
   k=$(value "($(end flat-$form 3 r1 1) - ($(end flat-$form 2 r1)))/($(end flat-$form 3 u1 1) - ($(end flat-$form 2 u1)))")
   loop=$(value "20*(4*0.0735/2 - 20/($k))")
   near "flat-$form: dissipation of the loop" "$(dissipation flat-$form 2 4)" "$loop" 1e-10
   near "flat-$form: work of the loop" "$(work flat-$form)" "$(dissipation flat-$form 2 4)" 1e-10
done
run 0 "$here/flat.inp" km --digits 17 --quiet --contact dense --set L=1e-3 --set F=1e-6
near 'flat, other units: dissipation' "$(dissipation km 2 4)" "$(value "1e-9*($(dissipation flat-dense 2 4))")" 1e-18

# 3. Pressed by a displacement: the force that is then there; nu times it where all slides
down=$(end push-dense 1 u2)
steps pressed "*STEP/*STATIC/*BOUNDARY/1000, 1/1000, 2, 2, $down/*END STEP/*STEP/*STATIC/0.1, 1/*BOUNDARY/1000, 1, 1, 0.08/*CONTACT PRINT, FREQUENCY=1/*END STEP"
both pressed pressed.inp
near 'pressed: force' "$(end pressed-dense 1 r2)" -20 1e-9
near 'pressed: plateau' "$(value "$(end pressed-dense 2 r1) + 0.5*($(end pressed-dense 2 r2))")" 0 1e-10

# 4. Released, with the force that held it as a load: nothing changes. Without a load it lets go linearly over the step.
steps released "*STEP/*STATIC/*BOUNDARY/1000, 1/1000, 2, 2, $down/*END STEP/*STEP/*STATIC/0.25, 1/*BOUNDARY, OP=NEW/BLOCK-BOTTOM, 1, 2/1000, 1/1000, 6/*CLOAD/1000, 2, $(end pressed-dense 1 r2)/*CONTACT PRINT, FREQUENCY=1/*END STEP"
both released released.inp
for increment in 1 2 3 4; do
   near "released, increment $increment: u2" "$(end released-dense 2 u2 $increment)" "$down" 1e-12
   near "released, increment $increment: reaction" "$(end released-dense 2 r2 $increment)" 0 0
done
steps fading "*STEP/*STATIC/*BOUNDARY/1000, 1/1000, 2, 2, $down/*CONTACT PRINT/*END STEP/*STEP/*STATIC/0.25, 1/*BOUNDARY, OP=NEW/BLOCK-BOTTOM, 1, 2/1000, 1/1000, 6/*CLOAD/1000, 2, -5/*CONTACT PRINT, FREQUENCY=1/*END STEP"
run 0 fading.inp fading --digits 17 --quiet
near 'fading: what the block carries in the middle' "$(awk '!/^#/ && $1 == 2 && $2 == 2 { print $5 }' fading/history.tab)" 12.5 1e-9

# 5. Free, and held again from where it is: at 0.5 half way to where it shall be
steps again "*STEP/*STATIC/*BOUNDARY/1000, 1/*CLOAD/1000, 2, -20/*END STEP/*STEP/*STATIC/0.5, 1/*BOUNDARY/1000, 2, 2, -0.02/*CONTACT PRINT, FREQUENCY=1/*END STEP"
both again again.inp
near 'held again: half way' "$(end again-dense 2 u2 1)" "$(value "($down - 0.02)/2")" 1e-12
near 'held again: there' "$(end again-dense 2 u2)" -0.02 1e-15

# 6. Turned to and fro along an amplitude: the same as its values one by one; a moment by an amplitude turns it as far
turn='*AMPLITUDE, NAME=WAVE/0, 0, 0.25, 1, 0.75, -1, 1, 0/*STEP/*STATIC/*BOUNDARY/1000, 1/*CLOAD/1000, 2, -20/*END STEP/*STEP/*STATIC/0.125, 1'
{ sed '/^\*STEP/,$d; /^1000, 6$/d; s/^<nu>$/0/' "$here/push.inp"
   echo "$turn/*BOUNDARY, AMPLITUDE=WAVE/1000, 6, 6, 0.003/*CONTACT PRINT, FREQUENCY=1/*END STEP" | tr / '\n'; } >wave.inp
both wave wave.inp
for pair in 1:0.5 2:1 3:0.5 4:0 5:-0.5 6:-1 7:-0.5 8:0; do
   near "turned, increment ${pair%:*}" "$(end wave-dense 2 ur ${pair%:*})" "$(value "0.003*(${pair#*:})")" 1e-16
done
near 'turned to and fro: opposite moments' "$(end wave-dense 2 moment 2)" "$(value "-($(end wave-dense 2 moment 6))")" 1e-9
near 'turned back: no moment' "$(end wave-dense 2 moment)" 0 1e-10
{ sed '/^\*STEP/,$d; /^1000, 6$/d; s/^<nu>$/0/' "$here/push.inp"
   echo "$turn/*CLOAD, AMPLITUDE=WAVE/1000, 6, $(end wave-dense 2 moment 2)/*CONTACT PRINT, FREQUENCY=1/*END STEP" | tr / '\n'; } >moment.inp
both moment moment.inp
near 'by a moment: rotation' "$(end moment-dense 2 ur 2)" 0.003 1e-11
near 'by a moment: rotation back' "$(end moment-dense 2 ur 6)" -0.003 1e-11

# The rotation alone is let go, with the moment that held it: it stays. One increment follows an amplitude, too.
{ sed '/^\*STEP/,$d; /^1000, 6$/d; s/^<nu>$/0/' "$here/push.inp"
   echo "*STEP/*STATIC/*BOUNDARY/1000, 1/1000, 6, 6, 0.003/*CLOAD/1000, 2, -20/*END STEP/*STEP/*STATIC/0.5, 1/*BOUNDARY, OP=NEW/BLOCK-BOTTOM, 1, 2/1000, 1/*CLOAD/1000, 6, $(end wave-dense 2 moment 2)/*CONTACT PRINT, FREQUENCY=1/*END STEP" | tr / '\n'; } >turns.inp
both turns turns.inp
near 'rotation let go: half way' "$(end turns-dense 2 ur 1)" 0.003 1e-12
near 'rotation let go' "$(end turns-dense 2 ur 2)" 0.003 1e-12
near 'rotation let go: no moment' "$(end turns-dense 2 moment 2)" 0 0
steps once '*AMPLITUDE, NAME=HALF/0, 0, 1, 0.5/*STEP/*STATIC/*BOUNDARY/1000, 2, 2, -0.02/*BOUNDARY, AMPLITUDE=HALF/1000, 1, 1, 0.001/*END STEP'
run 0 once.inp once --digits 17 --quiet
near 'one increment with an amplitude' "$(end once 1 u1)" 0.0005 1e-17

# Given anew by OP=NEW it goes on from where it is
steps anew '*STEP/*STATIC/*BOUNDARY/1000, 1/1000, 2, 2, -0.02/*END STEP/*STEP/*STATIC/0.5, 1, 0.5, 0.5/*BOUNDARY, OP=NEW/BLOCK-BOTTOM, 1, 2/1000, 6/1000, 1/1000, 2, 2, -0.03/*CONTACT PRINT, FREQUENCY=1/*END STEP'
both anew anew.inp
near 'given anew: half way' "$(end anew-dense 2 u2 1)" -0.025 1e-16
near 'given anew' "$(end anew-dense 2 u2 2)" -0.03 1e-16

# A rotation that is not small is told
{ sed '/^\*STEP/,$d; /^1000, 6$/d' "$here/push.inp"
   echo '*STEP/*STATIC/*BOUNDARY/1000, 1/1000, 6, 6, 0.2/*CLOAD/1000, 2, -20/*END STEP' | tr / '\n'; } >larger.inp
for form in dense sparse; do
   run 0 larger.inp larger-$form --digits 17 --contact $form
   says "large rotation, $form" larger-$form.err 'the largest rotation is 0.2 at node 1000 (0, 1)'
done

# 7. A force beyond nu N: the history ends where it begins to slide
steps beyond "*STEP/*STATIC/*BOUNDARY/1000, 1/*CLOAD/1000, 2, -20/*END STEP/*STEP/*STATIC/0.25, 1, 0.001/*BOUNDARY, OP=NEW/BLOCK-BOTTOM, 1, 2/1000, 6/*CLOAD/1000, 1, 12/*END STEP"
for form in dense sparse; do
   run 4 beyond.inp beyond-$form --digits 17 --contact $form --quiet
   says "beyond, $form" beyond-$form.err 'ended in step 2, increment'
   says "beyond, $form" beyond-$form.err 'rigid body PUNCH (reference node 1000)'
done
finish
