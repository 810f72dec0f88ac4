# check.sh ATRITO CASE_FOLDER INPUT_FOLDER
. "$(dirname "$0")/../lib.sh"
# pin NAME CODE "VARIABLES" [options]: a pin as pin.awk has it.
pin() {
   name=$1
   code=$2
   variables=$3
   shift 3
   set -- "$@" --digits 17 --quiet
   : >"$name.vars"
   eval "awk -v digits=17 -v angle=0 -v faces=24 -v holes=24 -v moment=0 -v gap=0 -v type=CPE4 -v force=10 -v hold=0 -v nu=0 $variables -f '$here/pin.awk'" \
      </dev/null >"$name.inp"
   run "$code" "$name.inp" "$name" "$@"
}
# turned NAME: the mean rotation of the pin, by its displacements across the radii.
turned() {
   awk '/^# columns:/ { for (i = 3; i <= NF; i++) place[$i] = i - 2; next } /^#/ { next }
      $2 < 10000 { x = $place["x"]; y = $place["y"]; m += x*$place["u2"] - y*$place["u1"]; r += x*x + y*y }
      END { printf "%.17g", m/r }' "$1/nodes.tab"
}
# carried NAME: the largest pressure, and that the motion is told and least. Statics give the reaction of the lug.
carried() {
   grep -q 'W-IDLE.*free to rotate about' "$1.err" || complain "$1: the rotation is not told"
   near "$1 turns by" "$(turned "$1")" 0 1e-9
   near "$1 reaction" "$(awk '!/^#/ { a += $(NF - 1); b += $NF } END { printf "%.17g", sqrt(a*a + b*b) }' "$1.sum")" 10 2e-3
}
reaction() {
   awk '/^# columns:/ { for (i = 3; i <= NF; i++) place[$i] = i - 2; next } /^#/ { next }
      { print $place["r1"], $place["r2"] }' "$1/reactions.tab" >"$1.sum"
}
most() { column "$1/contact.tab" pressure | awk '$1 > m { m = $1 } END { printf "%.17g", m }'; }

# A pin that its load does not turn: the same pressures to the digits, whatever digits, angle, elements, roles, quadrature, form, solver.
pin plain 0 ""
reaction plain
carried plain
for digits in 4 6 8 10 12; do
   for angle in 0 30 57.3 114.6; do
      pin free-$digits-$angle 0 "-v digits=$digits -v angle=$angle"
      reaction free-$digits-$angle
      carried free-$digits-$angle
      near "free-$digits-$angle pressure" "$(most free-$digits-$angle)" "$(most plain)" "$(value "10^(1 - $digits) + 1e-9")"
   done
done
for options in "--contact sparse" "--contact dense --solver sparse" "--contact dense --solver banded" "--contact dense --solver skyline"; do
   name=form-$(echo "$options" | tr -d ' -')
   pin "$name" 0 "-v digits=6 -v angle=57.3" $options
   reaction "$name"
   carried "$name"
   near "$name pressure" "$(most "$name")" "$(most free-6-57.3)" 1e-8
done
n=0
for variables in "-v slave=LUG" "-v type=CPE3" "-v holes=26" "-v holes=26 -v slave=LUG" "-v holes=26 -v quadrature=NODAL" "-v gap=0.001" "-v gap=0.001 -v holes=32"; do
   n=$((n + 1))
   for digits in 5 17; do
      pin "kind-$n-$digits" 0 "-v digits=$digits -v angle=57.3 $variables"
      reaction "kind-$n-$digits"
      carried "kind-$n-$digits"
   done
done
# A moment turns it: there is no equilibrium, however large the forces that rounded coordinates could hold it with.
n=0
for variables in "" "-v digits=6" "-v digits=6 -v holes=26" "-v digits=10 -v slave=LUG -v angle=30" "-v digits=5 -v type=CPE3" "-v digits=6 -v moment=-0.1"; do
   n=$((n + 1))
   for form in dense sparse; do
      pin "moment-$n-$form" 4 "-v moment=0.1 $variables" --contact $form
      says "moment $n $form" "moment-$n-$form.err" 'free to rotate about'
   done
done
# Friction, or a support, takes the moment.
pin rough 0 "-v digits=6 -v moment=0.1 -v nu=0.3"
grep -q W-IDLE rough.err && complain "rough: W-IDLE"
pin held 0 "-v digits=6 -v moment=0.1 -v hold=1"
grep -q W-IDLE held.err && complain "held: W-IDLE"
# The pin is a drawn line that moves with a reference node, or the hole is the end of a drawn slot: round sides as well.
drawn() { # NAME CODE DIGITS ANGLE MOMENT SLOT OPTION ...
   name=$1
   code=$2
   awk -v digits="$3" -v angle="$4" -v moment="$5" -v slot="$6" -f "$here/drawn.awk" </dev/null >"$name.inp"
   shift 6
   run "$code" "$name.inp" "$name" --digits 17 --quiet "$@"
}
drawn_turns() { # the same rotation at any angle and number of digits, as far as these tell
   turn=$(column "$1/rigid.tab" ur)
   near "$1 turns by" "$turn" "$(column drawn-0/rigid.tab ur)" "$(value "100*10^(1 - $digits)")"
}
for slot in 0 1; do
   drawn drawn-$slot 0 17 0 0 $slot
   for digits in 5 6 8 10; do
      for angle in 0 57.3; do
         for form in dense sparse; do
            name=drawn-$slot-$digits-$angle-$form
            drawn "$name" 0 $digits $angle 0 $slot --contact $form
            grep -q 'W-IDLE.*free to rotate about' "$name.err" || complain "$name: the rotation is not told"
            near "$name pressure" "$(most "$name")" "$(most drawn-$slot)" "$(value "1e4*10^(1 - $digits)*$(most drawn-$slot)")"
            near "$name stays" "$(column "$name/nodes.tab" u1 | awk '{ if ($1*$1 > m*m) m = $1 } END { printf "%.17g", m }')" 0 0.01
            [ $slot = 1 ] || drawn_turns "$name"
         done
         # in the slot it turns until the straight sides hold it
         drawn "drawn-moment-$slot-$digits-$angle" $((4 - 4*slot)) $digits $angle 0.01 $slot
      done
   done
done
# A ring on a pin, with an overlap that friction sticks in, and nothing holds them: both together may turn and move, and do not.
together() {
   awk '/^# columns:/ { for (i = 3; i <= NF; i++) place[$i] = i - 2; next } /^#/ { next }
      { x = $place["x"]; y = $place["y"]; m += x*$place["u2"] - y*$place["u1"]; r += x*x + y*y; n++ }
      END { printf "%.17g", m/r }' "$1/nodes.tab"
}
n=0
for variables in "" "-v holes=26" "-v slave=LUG" "-v holes=30 -v slave=LUG -v type=CPE3" "-v digits=6 -v angle=57.3 -v holes=27" \
   "-v digits=4 -v angle=30"; do
   n=$((n + 1))
   for form in dense sparse; do
      pin "shrunk-$n-$form" 0 "-v gap=-0.001 -v nu=0.4 -v force=0 -v loose=1 $variables" --contact $form
      grep -q 'W-IDLE' "shrunk-$n-$form.err" || complain "shrunk $n $form: the motion is not told"
      grep -q 'W-SUMS' "shrunk-$n-$form.err" && complain "shrunk $n $form: a moment is left"
      near "shrunk-$n-$form turns by" "$(together "shrunk-$n-$form")" 0 1e-9
   done
done
# A roller that stands on one node of its rim, on a flat that is inclined: its load goes through that node but for the last digits of
# the deck, which do not roll it onto the next one, where they are less than a thousandth of the load, with friction or without. A load that was
# meant to does.
for digits in 6 7 8 10 13; do
   for angle in 30 57.3 114.6; do
      for kind in "dense 0" "auto 0" "dense 0.2" "sparse 0.2"; do
         form=${kind% *}
         nu=${kind#* }
         name=roller-$digits-$angle-$form-$nu
         awk -v digits=$digits -v angle=$angle -v off=0 -v nu=$nu -f "$here/roller.awk" </dev/null >"$name.inp"
         run 0 "$name.inp" "$name" --digits 17 --quiet --contact $form
         grep -q 'W-IDLE' "$name.err" || complain "$name: the motion is not told"
         near "$name stays" "$(column "$name/nodes.tab" u1 | awk '{ if ($1*$1 > m*m) m = $1 } END { printf "%.17g", m }')" 0 0.01
      done
   done
   # as little in each increment of a history
   for form in dense sparse; do
      name=increments-$digits-$form
      awk -v digits=$digits -v angle=57.3 -v off=0 -v nu=0.2 -f "$here/roller.awk" </dev/null | awk '{ print } /^\*STATIC/ { print "0.25, 1." }' >"$name.inp"
      run 0 "$name.inp" "$name" --digits 17 --quiet --contact $form
      grep -q 'W-IDLE' "$name.err" || complain "$name: the motion is not told"
      near "$name stays" "$(column "$name/nodes.tab" u1 | awk '{ if ($1*$1 > m*m) m = $1 } END { printf "%.17g", m }')" 0 0.01
   done
   for nu in 0 0.2; do
      name=rolls-$digits-$nu
      awk -v digits=$digits -v angle=57.3 -v off=0.05 -v nu=$nu -f "$here/roller.awk" </dev/null >"$name.inp"
      run 0 "$name.inp" "$name" --digits 17 --quiet
      near "$name: points that carry" "$(column "$name/contact.tab" pressure | awk '$1 > 0 { n++ } END { print n + 0 }')" 2 0
   done
done
# The same of two rollers between plates: their forces come through contact alone, and their places are known to the digits as well.
for digits in 6 8 10 17; do
   for angle in 0 30 57.3; do
      for nu in 0 0.3; do
         name=rollers-$digits-$angle-$nu
         awk -v digits=$digits -v angle=$angle -v nu=$nu -f "$here/rollers.awk" </dev/null >"$name.inp"
         run 0 "$name.inp" "$name" --digits 17 --quiet
         grep -q 'W-IDLE' "$name.err" || complain "$name: the motion is not told"
         near "$name moves along by" "$(awk -v t=$angle '!/^#/ { p = t*atan2(1, 1)/45; u = $5*cos(p) + $6*sin(p); if (u*u > m*m) m = u }
            END { printf "%.17g", m }' "$name/nodes.tab")" 0 0.03
      done
   done
done
# farthest NAME: the largest displacement.
farthest() {
   awk '/^# columns:/ { for (i = 3; i <= NF; i++) place[$i] = i - 2; next } /^#/ { next }
      { u = $place["u1"]^2 + $place["u2"]^2; if (u > m) m = u } END { printf "%.17g", sqrt(m) }' "$1/nodes.tab"
}
# A roller between two races: both normals lie on one line, which rounding tilts; it neither spins nor rolls round until points beside them
# bear the little moment that this makes.
for type in CPE4 CPE3; do
   awk -v digits=17 -v angle=0 -v type=$type -f "$here/races.awk" </dev/null >races-$type.inp
   run 0 races-$type.inp races-$type --quiet
   for digits in 4 6 8 10 17; do
      for angle in 0 30 57.3 114.6; do
         name=races-$type-$digits-$angle
         awk -v digits=$digits -v angle=$angle -v type=$type -f "$here/races.awk" </dev/null >"$name.inp"
         run 0 "$name.inp" "$name" --quiet
         grep -q 'W-IDLE' "$name.err" || complain "$name: the motions are not told"
         grep -q 'W-LARGE' "$name.err" && complain "$name: the roller rolls on"
         near "$name moves by" "$(farthest "$name")" "$(farthest races-$type)" "$(value "10^(1 - $digits) + 1e-9")"
         near "$name presses with" "$(summary "$name" normal_resultant | sed 1q)" "$(summary races-$type normal_resultant | sed 1q)" 0.02
      done
   done
done
# A bar that hangs on a disc: what the digits make of the disc's load is taken out of that alone, and the bar stays without a load, in either form.
for nu in 0 0.3; do
   for digits in 6 8 17; do
      # of 8 digits the sparse form by itself does not always come to rest
      [ $digits = 8 ] && forms=dense || forms='dense sparse'
      for angle in 0 30 57.3 114.6; do
         for form in $forms; do
            name=hinged-$nu-$digits-$angle-$form
            awk -v digits=$digits -v angle=$angle -v nu=$nu -f "$here/hinged.awk" </dev/null >"$name.inp"
            run 0 "$name.inp" "$name" --quiet --contact $form
            grep -q 'W-IDLE' "$name.err" || complain "$name: the motion is not told"
            near "$name presses with" "$(summary "$name" normal_resultant)" 20 1e-4
            near "$name moves by" "$(farthest "$name")" "$(farthest hinged-$nu-6-0-dense)" 1e-4
         done
      done
   done
done
# A block in a slot, whose friction holds 2 nu N = 60: a push of 50 it holds, and of one of 70 nothing but rounding, which makes the slot
# narrower on one side, could hold it.
for digits in 4 5 6 8 10 17; do
   for angle in 0 30 57.3 114.6; do
      for form in dense sparse; do
         for force in 50 70; do
            name=slot-$digits-$angle-$form-$force
            awk -v digits=$digits -v angle=$angle -v nu=0.1 -v force=$force -f "$here/slot.awk" </dev/null >"$name.inp"
            run "$([ $force = 50 ] && echo 0 || echo 3)" "$name.inp" "$name" --quiet --contact $form
         done
         near "slot-$digits-$angle-$form: forces" "$(summary "slot-$digits-$angle-$form-50" normal_resultant | sed 1q)" 300 "$(value "3000*10^(1 - $digits) + 1e-8")"
      done
   done
done
# A block of generated nodes on an inclined line: those between the given corners have more digits, and would say that the pressure
# across the side of the block drives it along the line. A push along it does.
for digits in 6 8 12 17; do
   for angle in 17.3 30; do
      for n in 3 4 5 7; do
         for element in CPE4 CPE6 CPE8; do
            name=incline-$digits-$angle-$n-$element
            awk -v digits=$digits -v angle=$angle -v n=$n -v element=$element -v push=0 -f "$here/incline.awk" </dev/null >"$name.inp"
            run 0 "$name.inp" "$name" --digits 17 --quiet
            grep -q 'W-IDLE' "$name.err" || complain "$name: the motion is not told"
            near "$name is pressed by" "$(summary "$name" normal_resultant)" 2.8 "$(value "10^(1 - $digits) + 1e-12")"
         done
      done
      awk -v digits=$digits -v angle=$angle -v n=4 -v element=CPE8 -v push=0.05 -f "$here/incline.awk" </dev/null >pushed.inp
      run 4 pushed.inp pushed --quiet
      run 0 "incline-$digits-$angle-4-CPE8.inp" finer --refine 1 --quiet
   done
done
finish
