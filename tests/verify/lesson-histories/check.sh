#!/bin/sh
# The lessons of docs/user/lesson-press-and-push.md and lesson-there-and-back.md: closed forms, statics, and the numbers of the pages.
. "$(dirname "$0")/../lib.sh"
pages=$here/../../../docs/user

# at FOLDER COLUMN STEP INCREMENT: of history.tab.
at() {
   awk -v name="$2" -v step="$3" -v increment="$4" '/^# columns:/ { for (i = 3; i <= NF; i++) at[$i] = i - 2 }
      !/^#/ && $1 == step && $2 == increment { print $at[name] }' "$1/history.tab"
}
# middle FOLDER STEP INCREMENT: the shear at x = 0.
middle() {
   awk -v step="$2" -v increment="$3" '/^# columns:/ { for (i = 3; i <= NF; i++) at[$i] = i - 2 }
      !/^#/ && $1 == step && $at["increment"] == increment && $at["x"]^2 < 1e-16 { print $at["shear"] }' "$1/contact.tab"
}
# told PAGE TEXT VALUE FORMAT: the page has the value as it is found, rounded.
told() {
   # shellcheck disable=SC2059
   text=$(printf "$4" "$3" | sed 's/e-0/e-/')
   grep -qF -- "$text" "$pages/$1" || complain "$1: $2 is $text"
}

# 1. Two cylinders: Hertz, Cattaneo, Mindlin; R' = 5
run 0 "$input/lessons/press-and-push.inp" cylinders --digits 17
normal=$(at cylinders normal_resultant 1 1)
pi=$(value 'atan2(0, -1)')
stiffness=$(value '1000/(2*(1 - 0.09))')
half=$(value "sqrt(4*$normal*5/($pi*$stiffness))")
largest=$(value "2*$normal/($pi*$half)")
near 'largest pressure' "$(at cylinders max_pressure 1 1)" "$largest" "$(value "0.006*$largest")"
shear=$(value "-($(at cylinders shear_resultant 2 8))")
t=$(value "$shear/(0.3*$normal)")
near 'shear in the middle, pushed' "$(middle cylinders 2 8)" "$(value "-0.3*$largest*(1 - sqrt(1 - $t))")" "$(value "0.01*0.3*$largest")"
near 'shear in the middle, pushed back' "$(middle cylinders 3 16)" "$(value "-($(middle cylinders 2 8))")" "$(value "1e-4*$largest")"
loop=$(value "2*(0.3*$normal)^2/($pi*$stiffness)*($t*(2 - $t) + 2*(1 - $t)*log(1 - $t))")
found=$(value "$(at cylinders dissipation 4 16) - $(at cylinders dissipation 2 8)")
near 'dissipation of the loop' "$found" "$loop" "$(value "0.01*$loop")"
told lesson-press-and-push.md 'the normal force' "$normal" %.3f
told lesson-press-and-push.md 'the half width' "$half" %.4f
told lesson-press-and-push.md 'the largest pressure' "$(at cylinders max_pressure 1 1)" %.2f
told lesson-press-and-push.md 'the shear force' "$shear" %.4f
told lesson-press-and-push.md 'the shear in the middle' "$(value "-($(middle cylinders 2 8))")" %.3f
told lesson-press-and-push.md 'the shear force halfway' "$(at cylinders shear_resultant 3 8)" %.4f
told lesson-press-and-push.md 'the dissipation' "$(at cylinders dissipation 2 8)" %.3e
told lesson-press-and-push.md 'the dissipation in the end' "$(at cylinders dissipation 4 16)" %.3e
near 'points that stick, pushed' "$(at cylinders stick 2 8)" 15 0
near 'points that stick, halfway back' "$(at cylinders stick 3 8)" 17 0
run 0 "$input/lessons/press-and-push.inp" far --set way=0.008 --digits 17 --quiet
near 'all slides' "$(at far shear_resultant 2 8)" "$(value "-0.3*$normal")" 1e-8

# pressed and pushed at once: with memory all sticks, q = T/N p
together() { # FOLDER COUNT LENGTH STICK
   run 0 "$input/lessons/press-and-push.inp" "$1" --set together=0.003 --set piece="$3" --digits 17 --quiet
   near "$1: points that stick" "$(at "$1" stick 1 "$2")" "$4" 0
   ratio=$(value "-($(middle "$1" 1 "$2"))/(0.3*$(at "$1" max_pressure 1 "$2"))")
   told lesson-press-and-push.md "the shear in the middle, $2 increments at once" "$ratio" %.3f
   whole=$(value "-($(at "$1" shear_resultant 1 "$2"))/(0.3*$normal)")
   told lesson-press-and-push.md "T/(nu N), $2 increments at once" "$whole" %.3f
}
together once 1 1 15
near 'at once: Cattaneo' "$ratio" "$(value "1 - sqrt(1 - $whole)")" 0.003
together parts-10 10 0.1 19
together parts-50 50 0.02 21
together parts-500 500 0.002 21
together parts-200 200 0.005 21
near 'in 200 parts: the shear is T/N of the pressure' "$ratio" "$whole" "$(value "0.01*$whole")"
near 'in 200 parts: what slips' "$(at parts-200 slip 1 200)" 0 0
told lesson-press-and-push.md 'the shear force in 200 parts' "$(value "0.3*$normal*$whole")" %.4f

# 2. A block there and back
run 0 "$input/lessons/block-there-and-back.inp" block --digits 17 --quiet
for increment in 10 20; do
   near "there, increment $increment" "$(at block shear_resultant 2 $increment)" -10 1e-9
done
near 'back' "$(at block shear_resultant 2 60)" 10 1e-9
near 'the resultant there' "$(at block centre 2 20)" 1.25 1e-9
near 'the resultant back' "$(at block centre 2 60)" 0.75 1e-9
near 'the loop: elastic energy at its ends' "$(at block elastic_energy 2 100)" "$(at block elastic_energy 2 20)" 1e-9
told lesson-there-and-back.md 'the dissipation at time 1' "$(at block dissipation 2 20)" %.4f
told lesson-there-and-back.md 'the dissipation at time 5' "$(at block dissipation 2 100)" %.4f
told lesson-there-and-back.md 'the dissipation of the loop' "$(value "$(at block dissipation 2 100) - $(at block dissipation 2 20)")" %.4f
told lesson-there-and-back.md 'the first force' "$(value "-($(at block shear_resultant 2 1))")" %.2f
run 0 "$input/lessons/block-there-and-back.inp" short --set way=0.007 --digits 17 --quiet
run 0 "$input/lessons/block-there-and-back.inp" shorter --set way=0.004 --digits 17 --quiet
for increment in 20 60 100; do
   [ "$(at short stick 2 $increment)" -gt 0 ] || complain "a short way: all slides in increment $increment"
   [ "$(at short slip 2 $increment)" -gt 6 ] || complain "a short way: all sticks in increment $increment"
   near "a shorter way: what slips in increment $increment" "$(at shorter slip 2 $increment)" 0 0
done
near 'a shorter way: dissipation' "$(at shorter dissipation 2 100)" 0 0
finish
