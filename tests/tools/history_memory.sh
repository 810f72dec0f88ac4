#!/bin/sh
# A history holds few increments in memory, whatever is printed of how many: the peak of the process against what was predicted, and
# what becomes of a run whose increments find no room on the disk, or which is killed.
#    history_memory.sh ATRITO has-fields|no-fields
. "$(dirname "$0")/lib.sh"
atrito=$1
cd "$work" || exit 9

# history BODIES N INCREMENTS STEPS FREQUENCY REQUEST...: blocks of N x N/4 upon one another, pressed and sheared to and fro
history() {
   awk -v bodies="$1" -v n="$2" -v increments="$3" -v steps="$4" -v every="$5" -v requests=" $(shift 5; echo "$*") " 'BEGIN {
      for (b = 1; b <= bodies; b++)
         printf "*BLOCK, TYPE=CPE4, ELSET=B%d, NX=%d, NY=%d\n0., %d.\n4., %d.\n4., %d.\n0., %d.\n", b, n, n/4, b - 1, b - 1, b, b
      print "*MATERIAL, NAME=M\n*ELASTIC\n1000., .3"
      for (b = 1; b <= bodies; b++) printf "*SOLID SECTION, ELSET=B%d, MATERIAL=M\n1.\n", b
      print "*SURFACE INTERACTION, NAME=I\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1e5\n*FRICTION, NONLOCAL\n.3, 1e-5, .1"
      print "*CONTACT PAIR, INTERACTION=I"
      for (b = 2; b <= bodies; b++) printf "B%d-BOTTOM, B%d-TOP\n", b, b - 1
      print "*AMPLITUDE, NAME=A\n0., 0., .25, 1., .75, -1., 1., 0."
      print "*BOUNDARY\nB1-BOTTOM, 1, 2"
      if (requests ~ / restart /) printf "*RESTART, WRITE, FREQUENCY=%d\n", increments/2
      for (s = 1; s <= steps; s++) {
         printf "*STEP, INC=%d\n*STATIC\n%.15g, 1.\n", 10*increments, 1/increments
         printf "*BOUNDARY\nB%d-TOP, 2, 2, %.3g\n*BOUNDARY, AMPLITUDE=A\nB%d-TOP, 1, 1, .002\n", bodies, -.002*s, bodies
         if (requests ~ / nodes /) printf "*NODE PRINT, FREQUENCY=%d\nU, RF\n", every
         if (requests ~ / stress /) printf "*EL PRINT, FREQUENCY=%d\nS\n", every
         if (requests ~ / contact /) printf "*CONTACT PRINT, FREQUENCY=%d\n", every
         if (requests ~ / fields /)
            printf "*NODE FILE, FREQUENCY=%d\nU\n*EL FILE, FREQUENCY=%d\nS\n*CONTACT FILE, FREQUENCY=%d\n", every, every, every
         print "*END STEP"
      } }'
}

# predicted FILE: the bytes of the line 'memory, predicted ..... 24.1 MiB'
predicted() {
   awk '/memory, predicted/ { unit["B"] = 1; unit["KiB"] = 1024; unit["MiB"] = 1024^2; unit["GiB"] = 1024^3
      printf "%.0f\n", $(NF - 1)*unit[$NF]; exit }' "$1"
}

# measure NAME: solves NAME.inp; its peak is 1 to 1/1.3 of what check and listing say. The least of two runs: once in some hundred one
# takes 6 MB more, which the next does not.
measure() {
   "$atrito" check "$1.inp" >"$1.check" 2>&1 || fail "$1: check failed"
   peak=
   for run in 1 2; do
      "$atrito" "$1.inp" -o "$1" --quiet >"$1.err" 2>&1 || { fail "$1: failed"; cat "$1.err"; }
      peak=$(awk -v least="${peak:-1e300}" '/^# peak memory/ { printf "%.0f\n", $NF < least ? $NF : least }' "$1/timing.tab")
   done
   for of in "$1.check" "$1/$1.lst"; do
      awk -v what="$of" -v a="$(predicted "$of")" -v b="$peak" 'BEGIN {
         printf "%s: predicted %.1f MiB, peak %.1f MiB, ratio %.3f\n", what, a/2^20, b/2^20, a/b
         exit !(a/b >= 1 && a/b <= 1.3) }' </dev/null || fail "$of: not 1 to 1.3 of the peak"
   done
}

history 2 32 20 1 1 nodes stress contact >prints.inp
history 2 32 160 1 1 nodes stress contact >more.inp
history 8 16 20 1 2 nodes stress contact >bodies.inp
history 20 16 20 1 2 nodes stress contact >tower.inp
history 2 12 4 40 1 nodes contact >steps.inp
history 2 12 600 1 1 contact >long.inp
history 2 48 12 1 1 stress >finer.inp
names='prints more bodies tower steps long finer'
if [ "$2" = has-fields ]; then
   history 2 32 20 1 1 nodes stress contact fields >fields.inp
   history 2 32 20 1 1 nodes stress contact restart >restart.inp
   history 2 32 20 2 2 nodes stress contact fields restart >all.inp
   names="$names fields restart all"
fi
for name in $names; do
   measure "$name"
done
few=$(awk '/^# peak memory/ { print $NF }' prints/timing.tab)
many=$(awk '/^# peak memory/ { print $NF }' more/timing.tab)
[ "$((many*100))" -le "$((few*120))" ] || fail "eight times the increments take $many bytes, not $few"

# a limit that the tables keep and the increments on the disk do not: they stay in the memory
history 2 32 8 1 1 contact >small.inp
"$atrito" small.inp -o free --quiet || fail 'small.inp failed'
(ulimit -f 400 && "$atrito" small.inp -o limited --quiet) || fail 'small.inp failed under ulimit -f'
for table in contact summary extremes history iterations; do
   cmp "free/$table.tab" "limited/$table.tab" || fail "$table.tab is not the same where the increments find no room"
done

# killed while it is solved: nothing was there by name
"$atrito" more.inp -o killed --quiet &
sleep 0.5
kill -9 $! 2>/dev/null
wait $! 2>/dev/null
[ -z "$(find . -name '.atrito-*' -print)" ] || fail 'a killed run leaves a file of increments'
finish
