#!/bin/sh
# The scenes of this folder against what CalculiX finds for the same decks; a fourth argument is a folder with other references.
. "$(dirname "$0")/../lib.sh"
references=${4:-$here}

# last NAME STEP COLUMN: of history.tab at the end of the step.
last() {
   awk -v step="$2" -v name="$3" '/^# columns:/ { for (i = 3; i <= NF; i++) at[$i] = i - 2 }
      !/^#/ && $1 == step { found = $at[name] } END { print found == "" ? "none" : found }' "$1/history.tab"
}
# resultant NAME STEP COLUMN: of the reactions of the base; of bodies of revolution, whose hoop stress has a share in them, of the contact.
resultant() {
   if [ "${1%-total}" = ring ]; then
      [ "$3" = r1 ] && last "$1" "$2" shear_resultant || last "$1" "$2" normal_resultant
   else
      awk -v step="$2" -v name="$3" '/^# columns:/ { for (i = 3; i <= NF; i++) at[$i] = i - 2 }
         !/^#/ && $1 == step { sum += $at[name]; n++ } END { if (n) printf "%.17g", sum; else print "none" }' "$1/reactions.tab"
   fi
}
# reference NAME STEP FIELD: of the line of resultants.
reference() {
   awk -v step="$2" -v k="$3" '$1 == "resultant" && $2 == step { print $k }' "$references/$1.ccx"
}
# pressures NAME STEP REACH MIDDLE: how many points lie within REACH of the middle, and the largest difference there, relative to the point's own.
pressures() {
   awk -v step="$2" -v reach="$3" -v middle="$4" '
      FNR == NR { if ($1 == "point" && $2 == step) p[sprintf("%.5f", $3)] = $4; next }
      /^# columns:/ { for (i = 3; i <= NF; i++) at[$i] = i - 2 }
      !/^#/ && $1 == step {
         x = $at["x"]; key = sprintf("%.5f", x)
         if (x > middle + reach || x < middle - reach) next
         if (!(key in p) || p[key] + 0 <= 0) { bad = 1; next }
         n++; d = $at["pressure"]/p[key] - 1; if (d < 0) d = -d; if (d > most) most = d; if (sprintf("%g", d) ~ /n/) bad = 1 }
      END { if (bad || !n) print 0, "none"; else printf "%d %.17g", n, most }' "$references/$1.ccx" "$1/contact.tab"
}
# scene NAME STEPS REACH POINTS [MIDDLE]: forces within 1 % of the normal one, pressures within 3 % of themselves.
scene() {
   sh "$here/deck.sh" "$1" >"$1.inp"
   run 0 "$1.inp" "$1" --digits 17 --quiet
   for step in $(seq "$2"); do
      normal=$(reference "$1" "$step" 4)
      limit=$(value "0.01*$normal")
      shear=$(reference "$1" "$step" 3)
      near "$1, step $step: normal force" "$(resultant "$1" "$step" r2)" "$normal" "$limit"
      [ "$step" -eq 1 ] || limit=$(value "0.01*($shear < 0 ? -($shear) : $shear)")
      near "$1, step $step: shear force" "$(resultant "$1" "$step" r1)" "$shear" "$limit"
      # shellcheck disable=SC2046
      set -- "$1" "$2" "$3" "$4" "${5:-0}" $(pressures "$1" "$step" "$3" "${5:-0}")
      near "$1, step $step: points" "$6" "$4" 0
      near "$1, step $step: pressures" "$7" 0 0.03
   done
   forgets "$1" "$2"
}
# forgets NAME STEPS: the scene with friction that has no memory; whether a shear force is then more than 1 % off.
forgetful=''
forgets() {
   sed 's/^\*FRICTION/*FRICTION, SLIP=TOTAL/' "$1.inp" >"$1-total.inp"
   run 0 "$1-total.inp" "$1-total" --digits 17 --quiet
   most=0
   for step in $(seq 2 "$2"); do
      off=$(value "($(resultant "$1-total" "$step" r1))/($(reference "$1" "$step" 3)) - 1")
      most=$(echo "$off $most" | awk '{ d = $1 < 0 ? -$1 : $1; print (d > $2 ? d : $2) }')
   done
   echo "$1 without memory: the shear force is off by $most"
   [ "$(value "($most) > 0.01")" -eq 0 ] || forgetful="$forgetful $1"
}

# The corners of the blocks are left out: there the pressure of elastic bodies has no bound.
scene blocks 3 0.401 33
scene gap 3 0.401 33
scene unequal 3 0.401 49
scene eight 3 0.401 33
scene loaded 3 0.401 33
# half width 0.18 to 0.19; the elements of the edge are left out
scene cylinder 3 0.151 25
scene slides 3 0.401 33
scene ring 3 0.401 33 2
scene thin 3 0.401 33
# shellcheck disable=SC2086
[ "$(echo $forgetful | wc -w)" -ge 4 ] || complain "scenes that need memory: no more than$forgetful"
finish
