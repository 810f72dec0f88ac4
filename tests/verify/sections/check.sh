#!/bin/sh
# Cuts through bodies against statics; README.md has the formulas.
. "$(dirname "$0")/../lib.sh"

# force FOLDER CUT COLUMN [INCREMENT]: a value of sections.tab.
force() {
   awk -v cut="$2" -v name="$3" -v increment="${4:-}" '
      /^# columns:/ { for (i = 3; i <= NF; i++) at[$i] = i - 2 }
      !/^#/ && $2 == cut && (increment == "" || $at["increment"] == increment) { print $at[name] }' "$1/sections.tab"
}

# statics FOLDER CUT X SHEAR TOLERANCE: a cut of the beam that stands upright, with so much shear at the end.
statics() {
   near "$1 $2: n" "$(force "$1" "$2" n)" 1 "$5"
   near "$1 $2: v" "$(force "$1" "$2" v)" "$(value "$4 - 0.3*(10 - $3)")" "$5"
   near "$1 $2: m" "$(force "$1" "$2" m)" "$(value "$4*(10 - $3) - 0.15*(10 - $3)^2")" "$5"
   near "$1 $2: x" "$(force "$1" "$2" x)" "$3" 1e-12
}

# beam NAME TYPE [options]: the cantilever of such elements. The end has force 0.2 at each node: as many as the option FORCES says.
beam() {
   name=$1
   sed "s/TYPE=CPS4/TYPE=$2/" "$here/beam.inp" >"$name.inp"
   shift 2
   run 0 "$name.inp" "$name" --digits 17 --quiet "$@"
   shear=$(value "1.5 + $forces")
   statics "$name" X-1 3 "$shear" 1e-9
   statics "$name" X-2 5 "$shear" 1e-9
   statics "$name" X-3 5.13 "$shear" 1e-9
   statics "$name" X-4 0.1 "$shear" 1e-9
   statics "$name" X-5 9.93 "$shear" 1e-9
   statics "$name" X-6 0 "$shear" 1e-9
   statics "$name" X-7 10 "$shear" 1e-9
   near "$name: m of the cut drawn back" "$(force "$name" BACK m)" "$(value "-($(force "$name" X-3 m))")" 1e-9
   near "$name: v of the cut drawn back" "$(force "$name" BACK v)" "$(force "$name" X-3 v)" 1e-9
   # y = 0 at x = 6.375, y = 1 at x = 6.625: ahead a rectangle of 3.375 and half of 0.25 below, less above
   down=$(value "0.5*(0.2*(3.625 + 3.375)/2 + 0.4*3.375) - $shear")
   near "$name slanted: n" "$(force "$name" SLANTED n)" "$(value "(4*1 + $down)/sqrt(17)")" 1e-9
   near "$name slanted: v" "$(force "$name" SLANTED v)" "$(value "(1 - 4*$down)/sqrt(17)")" 1e-9
}

forces=0
beam plain CPS4
forces=1
beam skew CPS4 --set skew=0.5 --set force=0.2
beam reduced CPS4R --set skew=-0.4 --set force=0.2
beam triangles CPS3 --set skew=0.5 --set force=0.2
forces=1.8
beam eight CPS8 --set skew=0.5 --set force=0.2
beam nine CPS9 --set skew=0.5 --set force=0.2
beam six CPS6 --set skew=0.5 --set force=0.2
forces=0
beam fine CPS4 --set skew=0.5 --refine 1

run 0 "$here/bar.inp" bar --digits 17 --quiet
for cut in MIDDLE-1 MIDDLE-2; do
   near "bar $cut, half of the step" "$(force bar $cut n 1)" -3 1e-12
   near "bar $cut" "$(force bar $cut n 2)" -6 1e-12
   near "bar $cut: v" "$(force bar $cut v 2)" 0 1e-12
   near "bar $cut: m" "$(force bar $cut m 2)" 0 1e-12
done

for levels in 0 1; do
   run 0 "$here/ring.inp" ring --digits 17 --quiet --refine $levels
   near "ring $levels, 45 degrees: n" "$(force ring AT45 n)" 21 1e-10
   near "ring $levels, 45 degrees: v" "$(force ring AT45 v)" 0 1e-10
   near "ring $levels, foot: n" "$(force ring FOOT n)" 21 1e-10
   near "ring $levels, foot: m" "$(force ring FOOT m)" "$(force ring AT45 m)" 1e-10
   # the cut leaves the ring on a chord: of half the angle 90/16 degrees, 1.875 degrees beside its middle; refined 90/32 and 0.9375
   half=$(value "90/(16*(1 + $levels))*atan2(0, -1)/180")
   near "ring $levels, 30 degrees: n" "$(force ring AT30 n)" "$(value "21*cos($half)/cos($half/3)")" 1e-10
   near "ring $levels, 30 degrees: v" "$(force ring AT30 v)" 0 1e-10
done

# Lame's stress has the error of the mesh, and between lines of nodes that of a mean hoop stress in each element.
for ny in 6 7; do
   run 0 "$here/tube.inp" tube --digits 17 --quiet --set ny=$ny
   near "tube $ny: across" "$(force tube ACROSS-1 n)" "$(value '-3*atan2(0, -1)*5')" 1e-9
   near "tube $ny: across" "$(force tube ACROSS-2 n)" "$(value '-3*atan2(0, -1)*5')" 1e-9
   near "tube $ny: inner side" "$(force tube ROUND-1 n)" "$(value '-7*2*atan2(0, -1)*2*1.5')" 1e-9
   near "tube $ny: radius 2.5" "$(force tube ROUND-2 n)" "$(value '7*4/5*(1 - 9/2.5^2)*2*atan2(0, -1)*2.5*1.5')" 0.02
   near "tube $ny: radius 2.51" "$(force tube ROUND-3 n)" "$(value '7*4/5*(1 - 9/2.51^2)*2*atan2(0, -1)*2.51*1.5')" 0.05
done

printf '*CONTACT PAIR, INTERACTION=JOINT\nHIGH-BOTTOM, LOW-TOP\n' >joint.inp
cp "$here/two.inp" .
run 0 two.inp contact --digits 17
says 'two bodies are told' contact.err 'W-CROSSING'
says 'an edge is told' contact.err 'N-EDGE'
near 'contact: n of joints.tab' "$(column contact/joints.tab n)" "$(value "-($(force contact JOINT-1 n))")" 1e-11
near 'contact: t of joints.tab' "$(column contact/joints.tab t)" "$(force contact JOINT-2 v)" 1e-11
near 'contact: m of joints.tab' "$(column contact/joints.tab m)" "$(force contact JOINT-2 m)" 1e-10
printf '*TIE, NAME=GLUE\nHIGH-BOTTOM, LOW-TOP\n' >joint.inp
run 0 two.inp tied --digits 17 --quiet
for name in contact tied; do
   for cut in JOINT-1 JOINT-2 ABOVE BELOW; do
      near "$name $cut: n" "$(force $name $cut n)" -6 1e-10
   done
   # drawn from right to left the part ahead is above
   near "$name: v above" "$(force $name ABOVE v)" -1 1e-10
   near "$name: v below" "$(force $name BELOW v)" -1 1e-10
   near "$name: v in the joint" "$(force $name JOINT-1 v)" -1 1e-10
   near "$name: m above" "$(force $name ABOVE m)" -0.4 1e-10
   near "$name: m below" "$(force $name BELOW m)" -1.6 1e-10
   near "$name: both blocks" "$(force $name UPRIGHT length)" 2 1e-12
   near "$name: one block" "$(force $name HIGH length)" 1 1e-12
done

run 0 "$here/frame.inp" frame --digits 17
says 'two legs are told' frame.err 'goes through body FRAME 2 times'
near 'frame: both legs, n' "$(force frame LEGS n)" -6 1e-10
near 'frame: both legs, v' "$(force frame LEGS v)" -1 1e-10
near 'frame: sum of the legs' "$(value "$(force frame LEFT n) + $(force frame RIGHT n)")" -6 1e-10
near 'frame: sum of the legs, v' "$(value "$(force frame LEFT v) + $(force frame RIGHT v)")" -1 1e-10
near 'frame: the right leg' "$(force frame RIGHT x)" 4.5 1e-12

# the arch: joints 1, 3, 5 and crown, and a little beside it
awk '{ print } /JOINT PRINT/ {
   print "*SECTION PRINT, NAME=CROWN"; print "0, 0.5, 0, 1.5"; print "0.013, 0.5, 0.013, 1.5"
   print "*SECTION PRINT, NAME=FOOT"; print "-0.5, 0, -1.5, 0"
   print "*SECTION PRINT, NAME=JOINT"; print "-<xi2>, <yi2>, -<xo2>, <yo2>" }' "$input/lessons/arch.inp" >arch.inp
run 0 arch.inp arch --digits 17 --quiet
joint() {
   awk -v name="$2" -v pair="$1" '/^# columns:/ { for (i = 3; i <= NF; i++) at[$i] = i - 2 } !/^#/ && $at["pair"] == pair { print $at[name] }' arch/joints.tab
}
near 'arch: n at the crown is the thrust' "$(force arch CROWN-1 n)" "$(value "-($(joint 1 t))")" 1e-9
near 'arch: v at the crown' "$(force arch CROWN-1 v)" 0 1e-9
near 'arch: n beside it' "$(force arch CROWN-2 n)" "$(force arch CROWN-1 n)" 1e-9
near 'arch: weight beside it' "$(force arch CROWN-2 v)" "$(value '0.013*0.15*sin(4*atan2(0, -1)/9)')" 1e-9
near 'arch: n at the foot' "$(force arch FOOT n)" "$(value "-($(joint 1 n))")" 1e-9
near 'arch: n in a joint' "$(force arch JOINT n)" "$(value "-($(joint 3 n))")" 1e-9
near 'arch: m in a joint, upon the other stone' "$(force arch JOINT m)" "$(value "-($(joint 3 m))")" 1e-9
finish
