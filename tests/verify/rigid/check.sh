. "$(dirname "$0")/../lib.sh"

# deck NAME GENERATOR [NAME=VALUE ...]: a deck of punch.awk or roll.awk.
deck() {
   deck_name=$1
   generator=$2
   shift 2
   set -- "$@" end
   while [ "$1" != end ]; do set -- "$@" -v "$1"; shift; done
   shift
   awk "$@" -f "$here/$generator.awk" </dev/null >"$deck_name.inp"
}
# both NAME GENERATOR [NAME=VALUE ...]: run in both forms, which must agree.
both() {
   deck "$@"
   for form in dense sparse; do
      run 0 "$1.inp" "$1-$form" --digits 17 --contact $form --quiet
   done
   for name in u1 u2 ur r1 r2 moment; do
      case $name in u*) size=$(largest "$1-dense" u1 u2 ur) ;; *) size=$(largest "$1-dense" r1 r2 moment) ;; esac
      near "$1: $name of both forms" "$(rigid "$1-dense" $name)" "$(rigid "$1-sparse" $name)" "$(value "1e-9*$size")"
   done
   same_tables "$1: contact.tab of both forms" "$1-dense/contact.tab" "$1-sparse/contact.tab" 1e-9
}
# rigid FOLDER COLUMN: of the one rigid body.
rigid() {
   column "$1/rigid.tab" "$2"
}
# largest FOLDER COLUMN...: the largest of some columns by size; 1e-3 at the least, which is what loads are here
largest() {
   folder=$1
   shift
   for name; do rigid "$folder" "$name"; done | awk 'BEGIN { most = 1e-3 } { x = $1 < 0 ? -$1 : $1; if (x > most) most = x }
      END { printf "%.17g", most }'
}
# near_share WHAT VALUE EXPECTED SHARE
near_share() {
   near "$1" "$2" "$3" "$(value "$4*($3 < 0 ? -($3) : $3)")"
}
# at FOLDER X: the pressure at a place, linear between points.
at() {
   awk '/^# columns:/ { for (i = 3; i <= NF; i++) at[$i] = i - 2 } !/^#/ { print $at["x"], $at["pressure"] }' "$1/contact.tab" |
      sort -g | awk -v x="$2" '{ if (NR > 1 && last < x && x <= $1) found = v + ($2 - v)*(x - last)/($1 - last); last = $1; v = $2 }
         END { printf "%.17g", found }'
}
pi=$(value 'atan2(0, -1)')

# 1. Flat punch pressed by a force, rotation held: p = P/(pi sqrt(a^2 - x^2)). By the displacement that it then has: the same.
both force punch n=24 'step=*CLOAD/1000, 2, -1./*BOUNDARY/1000, 1, 1/1000, 6'
for x in -0.75 -0.5 -0.25 0.25 0.5 0.75; do
   wanted=$(value "1/($pi*sqrt(1 - $x*$x))")
   near_share "punch by force: p at $x" "$(at force-sparse $x)" "$wanted" 0.005
done
near 'punch by force: no reaction' "$(rigid force-dense r2)" 0 0
both displacement punch n=24 "step=*BOUNDARY/1000, 1, 1/1000, 2, 2, $(rigid force-dense u2)/1000, 6"
near 'punch by displacement: reaction' "$(rigid displacement-dense r2)" -1 1e-9
same_tables 'punch by force and by displacement' force-sparse/contact.tab displacement-sparse/contact.tab 1e-9
same_tables 'punch by force and by displacement, dense' force-dense/contact.tab displacement-dense/contact.tab 1e-8

# 2. Free punch under an eccentric load: it turns by 4 (1 - mu^2) M/(pi E a^2), and p has the factor 1 + 2 e x/a^2. The turn that it
#    is then given wants the moment again.
both eccentric punch n=24 'step=*CLOAD/1000, 2, -1./1000, 6, 0.3/*BOUNDARY/1000, 1'
near_share 'eccentric load: rotation' "$(rigid eccentric-dense ur)" "$(value "4*0.91*0.3/$pi")" 0.005
for x in -0.75 -0.5 -0.25 0.25 0.5 0.75; do
   wanted=$(value "(1 - 0.6*$x)/($pi*sqrt(1 - $x*$x))")
   near_share "eccentric load: p at $x" "$(at eccentric-sparse $x)" "$wanted" 0.006
done
both turned punch n=24 "step=*CLOAD/1000, 2, -1./*BOUNDARY/1000, 1/1000, 6, 6, $(rigid eccentric-dense ur)"
near 'rotation prescribed: moment of the reaction' "$(rigid turned-dense moment)" 0.3 1e-9

# 3. With friction, all free; turned by 30 degrees, and in other units: the same, in as many (outer) iterations.
both free punch n=16 'friction=*FRICTION/0.3' 'step=*CLOAD/1000, 1, 0.1/1000, 2, -1./1000, 6, 0.2'
c=$(value 'sqrt(3)/2')
both inclined punch n=16 angle=30 'friction=*FRICTION/0.3' \
   "step=*CLOAD/1000, 1, $(value "0.1*$c + 0.5")/1000, 2, $(value "0.05 - $c")/1000, 6, 0.2"
near_share 'inclined: rotation' "$(rigid inclined-dense ur)" "$(rigid free-dense ur)" 1e-9
near_share 'inclined: displacement' "$(value "$c*($(rigid inclined-dense u1)) + 0.5*($(rigid inclined-dense u2))")" \
   "$(rigid free-dense u1)" 1e-8
both units punch n=16 unit=1000 force=9.81 'friction=*FRICTION/0.3' 'step=*CLOAD/1000, 1, 0.981/1000, 2, -9.81/1000, 6, 1962.'
near_share 'other units: rotation' "$(rigid units-dense ur)" "$(rigid free-dense ur)" 1e-9
near_share 'other units: displacement' "$(rigid units-sparse u2)" "$(value "1000*($(rigid free-sparse u2))")" 1e-9
near 'units: iterations' "$(grep -vc '^#' units-dense/iterations.tab)" "$(grep -vc '^#' free-dense/iterations.tab)" 0
# Turned, two digits more are lost in the coordinates: on some processors an inner loop takes a last step among round-off more.
outer() { awk '!/^#/ { n = $2 } END { print n }' "$1/iterations.tab"; }
near 'inclined: outer iterations' "$(outer inclined-dense)" "$(outer free-dense)" 0
near 'units, sparse: iterations' "$(grep -vc '^#' units-sparse/iterations.tab)" "$(grep -vc '^#' free-sparse/iterations.tab)" 0

# 4. Pushed sideways by a displacement past what friction takes: the reaction is nu N, whatever the displacement.
for far in 10 1000; do
   both slide-$far punch n=8 'friction=*FRICTION/0.3' "step=*CLOAD/1000, 2, -1./*BOUNDARY/1000, 1, 1, $far./1000, 6"
   for form in dense sparse; do
      near "pushed by $far, $form: reaction" "$(rigid slide-$far-$form r1)" 0.3 1e-10
   done
done

# 5. A rigid cylinder pressed by displacement and by the force that it takes: the same tables. Axisymmetric: a sphere.
for case in CPE8:-3:0.3 CAX4:0:0 CPS3:-3:0; do
   type=${case%%:*}
   x0=${case#*:}
   nu=${x0#*:}
   x0=${x0%:*}
   held='1000, 1, 1/1000, 6, 6'
   both down-$type roll type=$type x0=$x0 nu=$nu "step=*BOUNDARY/$held/1000, 2, 2, -0.01"
   both push-$type roll type=$type x0=$x0 nu=$nu "step=*BOUNDARY/$held/*CLOAD/1000, 2, $(rigid down-$type-dense r2)"
   for form in dense sparse; do
      same_tables "roll, $type, $form: contact" down-$type-$form/contact.tab push-$type-$form/contact.tab 1e-9
   done
   near "roll, $type: u2" "$(rigid push-$type-dense u2)" -0.01 1e-11
done

# 6. The sums of the listing: what is applied goes into the supports, nothing into the ground by rigid surfaces.
grep -q 'from rigid surfaces' push-CPE8-dense/push-CPE8.lst && complain 'listing: a rigid surface that moves leaves a sum'
near 'listing: sum' "$(awk '/resultants  .*F1/ { at = 1 } at && $1 == "sum" { print $2 + $3; exit }' push-CPE8-dense/push-CPE8.lst)" 0 1e-11
grep -Eq '^   PUNCH +0 +-4.52146 +0 ' force-dense/force.lst || complain 'listing'
grep -Eq '^   sum +0 +0 +0$' force-dense/force.lst || complain 'listing: the sum and its moment'

# 7. A node that is held along x under a punch that is free to go there.
run 0 "$here/held.inp" held --digits 17 --quiet
near 'held nodes: the punch is in balance' "$(rigid held r1)" 0 0
near 'held nodes: shear resultant' "$(summary held shear_resultant)" -3 1e-9

# Two columns between platens, the upper one free, the lower one moved: what the upper one is loaded with comes out of the lower one,
# and the upper one has all motions of the lower one besides.
for form in dense sparse; do
   run 0 "$here/platens.inp" platens-$form --digits 17 --contact $form --quiet
   near "platens, $form: r1" "$(rigid platens-$form r1 | tail -1)" -2 1e-9
   near "platens, $form: r2" "$(rigid platens-$form r2 | tail -1)" 50 1e-9
   near "platens, $form: moment" "$(rigid platens-$form moment | tail -1)" 0 1e-9
done
sed 's/^2000, 1, 2, 0.01/2000, 1, 2, 0./; s/^2000, 6, 6, 0.002/2000, 6, 6, 0./' "$here/platens.inp" >resting.inp
run 0 resting.inp resting --digits 17 --quiet
near 'platens: u1 by the motion of the lower one' "$(value "$(rigid platens-dense u1 | head -1) - ($(rigid resting u1 | head -1))")" 0.004 1e-11
near 'platens: u2 by the motion of the lower one' "$(value "$(rigid platens-dense u2 | head -1) - ($(rigid resting u2 | head -1))")" 0.01 1e-11
near 'platens: rotation by that of the lower one' "$(value "$(rigid platens-dense ur | head -1) - ($(rigid resting ur | head -1))")" 0.002 1e-11

# 8. What nothing holds
deck loose punch n=4 'step=*CLOAD/1000, 1, 0.1/1000, 2, -1.'
deck pulled punch n=4 'step=*CLOAD/1000, 2, 1./*BOUNDARY/1000, 1/1000, 6'
sed '/CONTACT PAIR/d; /, PUNCH$/d' loose.inp >alone.inp
for name in loose pulled alone; do
   for form in dense sparse; do
      run 4 $name.inp $name --contact $form --quiet
      says $name $name.err 'rigid body PUNCH (reference node 1000)'
      absent $name
   done
done
says pulled pulled.err 'its supports (node 1000 along x1 and 1 more) do not prevent that'

# 9. The force that pushes a free punch off: nu N, and the mechanism is its motion
deck shove punch n=4 'friction=*FRICTION/0.3' 'step=*CLOAD/1000, 1, <H>/1000, 2, -1./*BOUNDARY/1000, 6'
sed 's/^rigid flat punch$/&\
*PARAMETER\
H = 0.1/' shove.inp >shoved.inp
rm -rf limit
"$atrito" limit shoved.inp -o limit --vary H=0:1 --digits 17 >limit.out 2>limit.err || complain "limit: exit $?"
near 'limit: falls' "$(sed -n 's/^# .*falls at \([-0-9.e+]*\).*/\1/p' limit/limit.tab)" 0.3 1e-6
says 'limit: mechanism' limit/mechanism.tab ' PUNCH '
finish
