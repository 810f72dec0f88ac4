#!/bin/sh
# The lessons of docs/user/first-deck.md: closed forms and statics, and what the page quotes is what the program prints.
. "$(dirname "$0")/../lib.sh"
page=$here/../../../docs/user/first-deck.md

# quoted TEXT FILE: stands in the page and in what was printed, blanks apart
quoted() {
   for place in "$page" "$2"; do
      tr -s ' ' <"$place" | grep -qF -- "$1" || complain "$place lacks: $1"
   done
}

run 0 "$input/lessons/block.inp" block
all_near 's22' block/stress.tab s22 -10 1e-12
near 'u2 of the top, q h/E' "$(column block/nodes.tab u2 | tail -n 1)" -0.01 1e-14
near 'u1 of the right side, mu q b/E' "$(column block/nodes.tab u1 | tail -n 1)" 0.006 1e-14
quoted 'solved 1 body, 32 elements, 45 nodes, 80 free displacements' block.out
quoted ' 1 45 2.000000000e+00 1.000000000e+00 6.000000000e-03 -1.000000000e-02 1' block/nodes.tab
# every line of the deck but its comments and numbers is explained
grep '^\*[A-Z]' "$input/lessons/block.inp" | while read -r line; do
   grep -qF -- "\`$line" "$page" || grep -qF -- "$line\`" "$page" || echo "$line"
done >unexplained
[ -s unexplained ] && complain "not explained: $(cat unexplained)"

for refine in 0 2; do
   run 0 "$input/lessons/block-on-floor.inp" floor --refine $refine
   near "N, --refine $refine" "$(summary floor normal_resultant)" 20 1e-10
   near "H, --refine $refine" "$(summary floor shear_resultant)" -4 1e-10
   near "the resultant, --refine $refine" "$(summary floor resultant_from_end)" 0.9 1e-10
   [ $refine -eq 2 ] || cp floor.out floor-0.out
done
quoted '1 BLOCK-BOTTOM on FLOOR 100 1.66 0.83001 0.9' floor-0.out
quoted ' normal 20, shear -4 [F]; max. p 16.6; 0 open, 9 stick, 0 slip' floor-0.out

run 4 "$input/lessons/block-on-floor.inp" slides --set push=12
quoted 'it slides (BLOCK-BOTTOM on FLOOR), the load drives it with H = 12 [F] and friction holds nu times N = 10 [F] at most (N = 20 [F]), 2 [F] too little' slides.err
run 0 "$input/lessons/block-on-floor.inp" pushed --set push=9 --refine 3
near 'where it sticks' "$(awk '!/^#/ && $12 == 2 { s = $4 } END { print s }' pushed/contact.tab)" 1.66 0.005

# two lines changed, as the page has them
law=$(sed -n 's/^    \(\*FRICTION, NONLOCAL\)$/\1/p' "$page")
values=$(sed -n 's/^    \(<nu>, .*\)$/\1/p' "$page")
sed "s/^\*FRICTION\$/$law/; s/^<nu>\$/$values/" "$input/lessons/block-on-floor.inp" >nonlocal.inp
grep -q '^\*FRICTION, NONLOCAL$' nonlocal.inp || complain 'the law is not changed'
run 0 "$input/lessons/block-on-floor.inp" local --set push=9 --refine 2
run 0 nonlocal.inp nonlocal --set push=9 --refine 2
near 'largest shear' "$(summary local max_abs_shear)" 11.83 0.005
near 'largest shear, nonlocal' "$(summary nonlocal max_abs_shear)" 10.38 0.005
near 'largest pressure' "$(summary local max_pressure)" 34.7 0.05
near 'largest pressure, nonlocal' "$(summary nonlocal max_pressure)" 33.9 0.05
for number in 11.83 10.38 34.7 33.9; do
   grep -qwF "$number" "$page" || complain "the page lacks $number"
done
finish
