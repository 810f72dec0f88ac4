. "$(dirname "$0")/../lib.sh"
wall=$input/lessons/wall-with-window.inp

# on_ground FOLDER: the sums of n, t and n x over the joints with the ground.
on_ground() {
   awk '/^# columns:/ { for (i = 3; i <= NF; i++) place[$i] = i - 2; next }
      !/^#/ && $place["body_2"] == 0 { n += $place["n"]; t += $place["t"]; m += $place["n"]*$place["x"] }
      END { printf "%.17g %.17g %.17g\n", n, t, m }' "$1/joints.tab"
}

# imbalance FOLDER: the largest sum of loads, supports and contact of a block along x and y.
imbalance() {
   awk '/^# columns:/ { for (i = 3; i <= NF; i++) place[$i] = i - 2; next }
      /^#/ { next }
      { for (k = 1; k <= 2; k++) {
           what = (k == 1) ? "_fx" : "_fy"
           d = $place["loads" what] + $place["supports" what] + $place["contact" what]
           if (d < 0) d = -d
           if (d > worst) worst = d } }
      END { printf "%.17g", worst }' "$1/bodies.tab"
}

for side in 0 0.3 0.5; do
   run 0 "$wall" "side$side" --set side=$side --digits 17 --quiet
   # shellcheck disable=SC2046 # three words
   set -- $(on_ground side$side)
   near "side $side: the weight" "$1" 26.25 1e-9
   near "side $side: the side load" "$2" "$(value "-26.25*$side")" 1e-9
   near "side $side: where they go into the ground" "$(value "$3/$1")" "$(value "1.5 + $side*5.15625/5.25")" 1e-9
   below "side $side: imbalance of a block" "$(imbalance side$side)" 1e-9
   [ "$(column side$side/bodies.tab body | wc -l)" -eq 45 ] || complain "side $side: not 45 blocks"
done
[ "$(column side0/bodies.tab name | sed -n '1p;$p' | tr '\n' ' ')" = 'LOW-1-1 BESIDE-2-1 ' ] || complain 'the names of the blocks'
near 'last block of the first course' "$(awk '!/^#/ && $4 == 0 { n = $5 } END { print n }' side0.3/joints.tab)" 9.341 1e-3

# beyond the limit of rigid blocks
run 4 "$wall" falls --set side=0.57 --quiet
says 'side 0.57' falls.err 'free to move under their loads'
says 'side 0.57' falls.err 'can rotate about (3, 0.625)'
# the courses slide at side = nu
run 0 "$wall" holds --set side=0.299 --set nu=0.3 --quiet
run 4 "$wall" slides --set side=0.31 --set nu=0.3 --quiet
says 'a course slides' slides.err 'the loads drive them with H = 1.1625 [F] and friction holds 1.125 [F] at most'
finish
