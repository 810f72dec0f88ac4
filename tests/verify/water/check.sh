. "$(dirname "$0")/../lib.sh"
cp "$here"/*.inp .
# sums WHAT FOLDER R1 R2 TOLERANCE: the reactions add up to these.
sums() {
   near "$1: along 1" "$(column "$2/reactions.tab" r1 | awk '{ s += $1 } END { printf "%.17g", s }')" "$3" "$5"
   near "$1: along 2" "$(column "$2/reactions.tab" r2 | awk '{ s += $1 } END { printf "%.17g", s }')" "$4" "$5"
}
# The foot lies on x2 = 0, so the reactions along 2 alone have a moment about the origin.
moment() {
   near "$1: moment" "$(awk '!/^#/ { x = $2 == 2 ? 0.5 : ($2 == 3 ? 1 : 0); s += x*$4 } END { printf "%.17g", s }' \
      "$2/reactions.tab")" "$3" "$4"
}

# dam NAME DECK LEVEL: 10 at the foot, thickness 2.
dam() {
   run 0 "$2" "$1" --set level="$3" --digits 17 --quiet
   sums "$1" "$1" "$(value "-10*$3")" 0 1e-10
   moment "$1" "$1" "$(value "10*$3*$3/3")" 1e-10
}
sed 's/^\*DSLOAD/*DLOAD/; s/^FACE, HP, \(.*\)/1, HP4, \1|3, HP4, \1/' dam.inp | tr '|' '\n' >faces.inp
for level in 2 1.7 1 0.3; do
   dam "dam-$level" dam.inp $level
   dam "faces-$level" faces.inp $level
done
for level in 1.7 0.3; do same_tables "faces $level" dam-$level/nodes.tab faces-$level/nodes.tab 1e-14; done
# The same as functions of the place, which are exact where the level is at the end of a face; also on a finer mesh.
sed 's/^\*DSLOAD/&, FUNCTION/; s/^FACE, HP, .*/FACE, P, 10*max(0, 1 - y\/level)/' dam.inp >function.inp
run 0 function.inp function --set level=1 --digits 17 --quiet
same_tables 'a function' dam-1/nodes.tab function/nodes.tab 1e-14
run 0 function.inp function-finer --set level=1 --refine 1 --digits 17 --quiet
sums 'a function, refined' function-finer -10 0 1e-10
sed 's/^\*DSLOAD/&, FUNCTION/; s/^FACE, HP, .*/FACE, TRVEC, level*3*y*y, 4, 3/' dam.inp >shear.inp
run 0 shear.inp shear --set level=2 --digits 17 --quiet
sums 'a traction' shear "$(value '-2*16*0.8')" "$(value '-2*16*0.6')" 1e-10
near 'its resultant' "$(awk '$3 == "DSLOAD" { print $5 }' shear/resultants.tab)" 19.2 1e-10
# A level above the block: 10 at the foot, 10 (3 - 2)/3 at the top.
run 0 dam.inp over --set level=3 --digits 17 --quiet
sums 'over the top' over "$(value '-2*(10 + 10/3)')" 0 1e-10
# The side leans in by 0.3: as much water lies over it as 2*10 a unit of depth and half the base times the height.
run 0 dam.inp lean --set level=1 --set lean=0.3 --digits 17 --quiet
sums 'a side that leans' lean -10 "$(value '10*0.3')" 1e-10
# Suction, and pressure from above: the level of the magnitude lies over that of zero.
sed 's/HP, 10, <level>, 0/HP, -10, 0.7, 2/' dam.inp >suck.inp
run 0 suck.inp suck --digits 17 --quiet
sums 'from above' suck 13 0 1e-10

# The parabolas of the outer side are not quite arcs: their length by Simpson's rule on 2000 intervals.
length=$(awk 'BEGIN { pi = 4*atan2(1, 1); n = 2000
   x1 = 2; y1 = 0; x2 = sqrt(2); y2 = sqrt(2); x3 = 2*cos(pi/8); y3 = 2*sin(pi/8)
   for (i = 0; i <= n; i++) { t = 2*i/n - 1; w = i == 0 || i == n ? 1 : (i % 2 ? 4 : 2)
      dx = (t - 0.5)*x1 + (t + 0.5)*x2 - 2*t*x3; dy = (t - 0.5)*y1 + (t + 0.5)*y2 - 2*t*y3
      s += w*sqrt(dx*dx + dy*dy) }
   printf "%.17g", 2*s*2/n/3 }')
near 'nearly an arc' "$length" "$(value '4*atan2(1, 1)')" 2e-3
run 0 arc.inp traction --digits 17 --quiet
sums traction traction "$(value "-7*0.6*$length")" "$(value "-7*0.8*$length")" 1e-9
sed 's/^OUTER, TRVEC, 7, 3, 4/OUTER, TRVEC, 14, -0.03, -0.04, 0/' arc.inp >back.inp
run 0 back.inp back --digits 17 --quiet
same_tables 'twice and back' traction/nodes.tab back/nodes.tab 1e-12 u1=-2 u2=-2
sed 's/^\*DSLOAD/*DLOAD/; s/^OUTER, TRVEC/ALL, TRVEC2/' arc.inp >elements.inp
run 0 elements.inp elements --digits 17 --quiet
same_tables 'on faces of elements' traction/nodes.tab elements/nodes.tab 1e-14

# Fluid of weight 5 up to the level 2 around the ring: pushes as on the vertical, and as it lies over the side. By Gauss' theorem the
# part along 2 is the weight between side and level, 5*(4 - area under the side), of the parabolas themselves.
area=$(awk 'BEGIN { pi = 4*atan2(1, 1); n = 2000
   x[1] = 2; y[1] = 0; x[2] = sqrt(2); y[2] = sqrt(2); x[3] = 2*cos(pi/8); y[3] = 2*sin(pi/8)
   for (i = 0; i <= n; i++) { t = 2*i/n - 1; w = i == 0 || i == n ? 1 : (i % 2 ? 4 : 2)
      px = t*(t - 1)/2*x[1] + t*(t + 1)/2*x[2] + (1 - t*t)*x[3]; py = t*(t - 1)/2*y[1] + t*(t + 1)/2*y[2] + (1 - t*t)*y[3]
      dx = (t - 0.5)*x[1] + (t + 0.5)*x[2] - 2*t*x[3]; dy = (t - 0.5)*y[1] + (t + 0.5)*y[2] - 2*t*y[3]
      s += w*(px*dy - py*dx)/2 }
   printf "%.17g", 2*s*2/n/3 }')
sed 's/^OUTER, TRVEC.*/OUTER, HP, 10, 2, 0/' arc.inp >fluid.inp
run 0 fluid.inp fluid --digits 17 --quiet
sums fluid fluid 10 "$(value "5*(4 - $area)")" 1e-9
grep -Eq '^   pressure on faces +-10 ' fluid/fluid.lst || complain 'the listing'
# Half of it: the level cuts the curved faces.
sed 's/^OUTER, TRVEC.*/OUTER, HP, 5, 1, 0/' arc.inp >half.inp
run 0 half.inp half --digits 17 --quiet
near 'fluid to the half' "$(column half/reactions.tab r1 | awk '{ s += $1 } END { printf "%.17g", s }')" 2.5 1e-9
finish
