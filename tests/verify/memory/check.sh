#!/bin/sh
# Memory predicted by `atrito check` and by the listing, over the peak of the process.
. "$(dirname "$0")/../lib.sh"
bench=$here/../../bench

# predicted FILE: the bytes of the line 'memory, predicted ..... 24.1 MiB'.
predicted() {
   awk '/memory, predicted/ { unit["B"] = 1; unit["KiB"] = 1024; unit["MiB"] = 1024^2; unit["GiB"] = 1024^3
      printf "%.0f\n", $(NF - 1)*unit[$NF]; exit }' "$1"
}

# between WHAT VALUE PEAK: 1 <= VALUE/PEAK <= 1.3.
between() {
   awk -v what="$1" -v a="$2" -v b="$3" 'BEGIN {
      good = a ~ /^[0-9]+$/ && b ~ /^[0-9]+$/ && b + 0 > 0
      if (good) printf "%s: predicted %.1f MiB, peak %.1f MiB, ratio %.3f\n", what, a/2^20, b/2^20, a/b
      exit !(good && a/b >= 1 && a/b <= 1.3) }' </dev/null || complain "$1"
}

# memory NAME DECK [options]: predicts and runs.
memory() {
   name=$1
   deck=$2
   shift 2
   "$atrito" check "$deck" "$@" >"$name.check" 2>&1 || complain "$name: check failed"
   run 0 "$deck" "$name" --quiet "$@"
   peak=$(awk '/^# peak memory/ { print $NF }' "$name/timing.tab")
   between "$name, check" "$(predicted "$name.check")" "$peak"
   between "$name, listing" "$(predicted "$name/$(basename "$deck" .inp).lst")" "$peak"
}

# layers N: two layers of N x 5 squares, pressed together and sheared.
layers() {
   cat <<END
*BLOCK, TYPE=CPE4, ELSET=LOWER, NX=$1, NY=5
0., 0.
$(($1/5))., 0.
$(($1/5))., 1.
0., 1.
*BLOCK, TYPE=CPE4, ELSET=UPPER, NX=$1, NY=5
0., 1.
$(($1/5))., 1.
$(($1/5))., 2.
0., 2.
*MATERIAL, NAME=M
*ELASTIC
1000., .3
*SOLID SECTION, ELSET=LOWER, MATERIAL=M
1.
*SOLID SECTION, ELSET=UPPER, MATERIAL=M
1.
*SURFACE INTERACTION, NAME=I
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR
1e7
*FRICTION, NONLOCAL
.3, 1e-7, .01
*CONTACT PAIR, INTERACTION=I
UPPER-BOTTOM, LOWER-TOP
*BOUNDARY
LOWER-BOTTOM, 1, 2
*STEP
*STATIC
*BOUNDARY
UPPER-TOP, 2, 2, -.01
UPPER-TOP, 1, 1, .007
*NODE PRINT
U
*CONTACT PRINT
*END STEP
END
}

# tapered: the deck of standard input with a lower block of which no two elements are equal.
tapered() {
   sed -e 's/^0\., 0\.$/-.3, 0./' -e 's/^2\., 0\.$/2.35, .07/'
}

# courses N M: N blocks upon one another, with M x 4 elements, pressed by their weight and by the topmost.
courses() {
   awk -v n="$1" -v m="$2" 'BEGIN {
      for (b = 1; b <= n; b++) {
         printf "*BLOCK, TYPE=CPE4, ELSET=B%d, NX=%d, NY=4\n0., %d.\n2., %d.\n2., %d.\n0., %d.\n", b, m, b - 1, b - 1, b, b }
      print "*MATERIAL, NAME=M\n*ELASTIC\n1e6, .2\n*DENSITY\n2."
      for (b = 1; b <= n; b++) printf "*SOLID SECTION, ELSET=B%d, MATERIAL=M\n1.\n", b
      print "*SURFACE INTERACTION, NAME=I\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1e8\n*FRICTION\n.6, 1e8"
      print "*CONTACT PAIR, INTERACTION=I"
      for (b = 2; b <= n; b++) printf "B%d-BOTTOM, B%d-TOP\n", b, b - 1
      print "*BOUNDARY\nB1-BOTTOM, 1, 2\n*STEP\n*STATIC\n*DLOAD"
      for (b = 1; b <= n; b++) printf "B%d, GRAV, 9.81, 0., -1.\nB%d, BX, 1.\n", b, b
      print "*NODE PRINT\nU\n*CONTACT PRINT\n*END STEP" }'
}

memory small "$input/ex1-plate-on-support.inp"
sh "$bench/scene-a.sh" 11 >plate.inp
memory skyline plate.inp --solver skyline
memory banded plate.inp --solver banded
memory sparse plate.inp --solver sparse
sh "$bench/scene-p.sh" 100 >blocks.inp
tapered <blocks.inp >tapered.inp
memory unequal tapered.inp --solver sparse
cmp -s blocks.inp tapered.inp && complain 'no element was changed'
sh "$bench/explicit-deck.sh" 102 12 >digits.inp
memory digits digits.inp --solver sparse
memory digits-sparse-form digits.inp --contact sparse
sed 's/CPE4/CPE9/' blocks.inp >nine.inp
memory nine nine.inp
memory refined "$input/ex3-pillar-in-ground.inp" --refine 4
sh "$here/../order/ring.sh" 3000 >ring.inp
memory ring ring.inp
sh "$here/../order/askew.sh" >askew.inp
memory askew askew.inp
layers 1000 >layers.inp
memory layers layers.inp --contact sparse
layers 300 >line.inp
memory line line.inp --contact dense
courses 20 20 >courses.inp
memory courses courses.inp --contact dense
memory wall courses.inp --contact sparse
finish
