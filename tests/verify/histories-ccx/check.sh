#!/bin/sh
# The scenes of this folder against what CalculiX finds for the same decks; a fourth argument is a folder with other references.
. "$(dirname "$0")/../lib.sh"
references=${4:-$here}

# resultant NAME STEP COLUMN: of the reactions of the base.
resultant() {
   awk -v step="$2" -v name="$3" '/^# columns:/ { for (i = 3; i <= NF; i++) at[$i] = i - 2 }
      !/^#/ && $1 == step { sum += $at[name]; n++ } END { if (n) printf "%.17g", sum; else print "none" }' "$1/reactions.tab"
}
# reference NAME STEP FIELD: of the line of resultants.
reference() {
   awk -v step="$2" -v k="$3" '$1 == "resultant" && $2 == step { print $k }' "$references/$1.ccx"
}
# pressures NAME STEP REACH: how many points lie within REACH of the middle, and the largest difference there, relative to the point's own.
pressures() {
   awk -v step="$2" -v reach="$3" '
      FNR == NR { if ($1 == "point" && $2 == step) p[sprintf("%.5f", $3)] = $4; next }
      /^# columns:/ { for (i = 3; i <= NF; i++) at[$i] = i - 2 }
      !/^#/ && $1 == step {
         x = $at["x"]; key = sprintf("%.5f", x)
         if (x > reach || x < -reach) next
         if (!(key in p) || p[key] + 0 <= 0) { bad = 1; next }
         n++; d = $at["pressure"]/p[key] - 1; if (d < 0) d = -d; if (d > most) most = d; if (sprintf("%g", d) ~ /n/) bad = 1 }
      END { if (bad || !n) print 0, "none"; else printf "%d %.17g", n, most }' "$references/$1.ccx" "$1/contact.tab"
}
# scene NAME STEPS REACH POINTS: forces within 1 % of the normal one, pressures within 3 % of themselves.
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
      set -- "$1" "$2" "$3" "$4" $(pressures "$1" "$step" "$3")
      near "$1, step $step: points" "$5" "$4" 0
      near "$1, step $step: pressures" "$6" 0 0.03
   done
}

# The corners of the blocks are left out: there the pressure of elastic bodies has no bound.
scene blocks 2 0.401 33
scene gap 3 0.401 33
scene unequal 3 0.401 49
scene eight 2 0.401 33
scene loaded 3 0.401 33
# half width 0.18 to 0.19; the elements of the edge are left out
scene cylinder 2 0.151 25
finish
