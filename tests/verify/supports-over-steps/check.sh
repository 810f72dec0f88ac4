#!/bin/sh
# Supports of before the first step that steps move and let go.
. "$(dirname "$0")/../lib.sh"

# at FOLDER TABLE COLUMN STEP INCREMENT NODE
at() {
   awk -v name="$3" -v step="$4" -v increment="$5" -v node="$6" '
      /^# columns:/ { for (i = 3; i <= NF; i++) at[$i] = i - 2 }
      !/^#/ && $1 == step && $at["increment"] == increment && $2 == node { found = $at[name]; n++ }
      END { print n == 1 ? found : "none" }' "$1/$2.tab"
}

for options in '' '--refine 1'; do
   # shellcheck disable=SC2086
   run 0 "$here/square.inp" square --digits 17 $options
   says 'what is let go is told' square.err '[N-RELEASED]'
   for increment in 1 2 3 4; do
      left=$(value "-0.002*$increment/4")
      near "moved, increment $increment: left" "$(at square nodes u1 1 $increment 4)" "$left" 1e-16
      near "moved, increment $increment: right" "$(at square nodes u1 1 $increment 3)" "$(value "$left + 0.00182*$increment/4")" 1e-15
      left=$(value "-0.002*(1 - $increment/4)")
      near "back, increment $increment: left" "$(at square nodes u1 2 $increment 4)" "$left" 1e-16
      near "back, increment $increment: right" "$(at square nodes u1 2 $increment 3)" \
         "$(value "$left + 0.00182 + 0.00018*$increment/4")" 1e-15
      near "back, increment $increment: across" "$(at square nodes u2 2 $increment 3)" "$(value "-0.0006*$increment/4")" 1e-15
      near "on, increment $increment: left" "$(at square nodes u1 3 $increment 1)" "$(value "0.004*$increment/4")" 1e-16
   done
   near 'held across' "$(at square nodes u2 1 4 3)" 0 0
   near 'end: right' "$(at square nodes u1 3 4 2)" 0.006 1e-15
   near 'end: across' "$(at square nodes u2 3 4 4)" -0.0006 1e-15
   # 4 has a reaction across as long as it is held
   near 'reaction across while it is held' "$(at square reactions r2 1 4 4)" "$(awk -v o="$options" 'BEGIN { print o ? 0.15 : 0.3 }')" 1e-12
   near 'no reaction across then' "$(at square reactions r2 3 4 4)" 0 1e-12
done
finish
