#!/bin/sh
# Cracks whose faces share the nodes of their tips; README.md has what is exact.
. "$(dirname "$0")/../lib.sh"

# crack NAME NAME=VALUE ...: crack.awk, run in both forms.
crack() {
   name=$1
   shift
   set -- "$@" end
   while [ "$1" != end ]; do set -- "$@" -v "$1"; shift; done
   shift
   awk "$@" -f "$here/crack.awk" </dev/null >"$name.inp"
   for form in dense sparse; do run 0 "$name.inp" "$name-$form" --digits 17 --contact $form; done
   grep -q 'N-TIP' "$name-dense.err" || complain "$name: not told"
}
# pressed NAME POINTS [TOLERANCE]: a pressure of 1 at so many points, but for the corner in the middle of a kinked crack.
pressed() {
   for form in dense sparse; do
      near "$1, $form: points" "$(grep -vc '^#' "$1-$form/contact.tab")" "$2" 0
      below "$1, $form: pressure" "$(awk '/^# columns:/ { for (i = 3; i <= NF; i++) at[$i] = i - 2 }
         !/^#/ && ($at["x"]^2 + $at["y"]^2 > 1e-6) { d = $at["pressure"] - 1; if (d < 0) d = -d; if (d > most) most = d }
         END { printf "%.17g", most }' "$1-$form/contact.tab")" "${3:-1e-10}"
   done
}

# 1. Pressure all round: every element, both roles, matching sides and others, one tip and two, any angle.
for type in CPS3 CPE4 CPS6 CPE8 CPS9; do
   n=7
   case $type in *[689]) n=15 ;; esac
   crack "matching-$type" type=$type up=8 beside=3 rows=3
   pressed "matching-$type" $n
   crack "mortar-$type" type=$type up=8 low=11 beside=3 rows=3 angle=57.3
   pressed "mortar-$type" $n
done
crack other-role up=8 low=11 beside=3 rows=3 'roles=LOW, UP'
pressed other-role 10
crack other-role-2 type=CPS8 up=8 low=11 beside=3 rows=3 'roles=LOW, UP' quadrature=MORTAR angle=90
pressed other-role-2 21
crack one-tip up=8 low=11 beside=3 rows=3 tips=1 angle=30
pressed one-tip 8
crack one-tip-2 type=CPS6 up=8 beside=3 rows=3 tips=1 angle=114.6
pressed one-tip-2 16
crack kinked type=CPS4 up=8 beside=3 rows=3 kink=0.3
pressed kinked 7
crack kinked-mortar type=CPS8 up=8 low=12 beside=3 rows=3 kink=0.3 quadrature=MORTAR
# the mean normal of the corner is in the rows beside it
pressed kinked-mortar 15 0.005

# 2. Shear besides: the faces slip, held by nu p; in the middle by 4 (tau - nu sigma) a/E in an infinite plate.
crack slips up=12 beside=9 rows=15 shear=0.5
pressed slips 11
all_near 'shear of the faces' slips-dense/contact.tab shear -0.3 1e-10
near 'slip in the middle' "$(column slips-dense/contact.tab slip | sed -n 6p)" 0.00032 0.00002
crack slips-mortar type=CPS8 up=8 low=11 beside=5 rows=8 shear=0.5 angle=30
all_near 'shear of the faces, mortar' slips-mortar-dense/contact.tab status 2 0
near 'slip in the middle, mortar' "$(column slips-mortar-dense/contact.tab slip | sed -n 8p)" 0.00032 0.00003

# 3. A slave of one face of the first degree has no node that could carry contact.
awk -v up=1 -v low=3 -v beside=2 -v rows=2 -f "$here/crack.awk" </dev/null >short.inp
run 2 short.inp short --quiet
says 'a short slave' short.err 'the slave has no other nodes than the tips of the crack'
finish
