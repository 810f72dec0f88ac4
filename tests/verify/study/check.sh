. "$(dirname "$0")/../lib.sh"
pillar=$input/ex3-pillar-in-ground.inp
# value_of LEVEL ELEMENT COLUMN of study.tab
value_of() {
   awk -v level="$1" -v element="$2" -v name="$3" '/^# columns:/ { for (i = 3; i <= NF; i++) c[$i] = i - 2; next }
      !/^#/ && $1 == level && $2 == element { print $c[name] }' out/study.tab
}
"$atrito" study "$pillar" --levels 3 --elements cps4,cps9 --reference strain_energy --reference normal_resultant=2.8e5 -o out \
   --digits 17 >said 2>told || complain "study: exit $?"
near 'rows' "$(grep -vc '^#' out/study.tab)" 6 0
# A level is the deck with --refine and the sparse solver; the elements of the deck are those of the deck.
for level in 0 1 2; do
   run 0 "$pillar" "level-$level" --refine $level --solver sparse --digits 17 --quiet
   for quantity in strain_energy normal_resultant error_estimate_percent; do
      near "cps9, level $level, $quantity" "$(value_of $level cps9 $quantity)" "$(summary level-$level $quantity)" 0
   done
   "$atrito" compare "level-$level" "out/cps9_$level" --rtol 0 >/dev/null || complain "level $level: other tables"
done
# Four-node elements on the same nodes: as many displacements, half the size, more energy of a body whose motion is prescribed.
near 'dofs of cps4' "$(value_of 2 cps4 dofs)" "$(value_of 2 cps9 dofs)" 0
near 'size of cps4' "$(value_of 2 cps4 h)" "$(awk -v h="$(value_of 2 cps9 h)" 'BEGIN { printf "%.17g", h/2 }')" 1e-14
awk -v a="$(value_of 2 cps4 strain_energy)" -v b="$(value_of 2 cps9 strain_energy)" 'BEGIN { exit !(a > b) }' ||
   complain 'cps4 is softer than cps9'
# Errors are against the given value, or the limit.
near 'error against a given value' "$(value_of 1 cps9 normal_resultant_error)" \
   "$(awk -v v="$(value_of 1 cps9 normal_resultant)" 'BEGIN { printf "%.17g", (v - 2.8e5)/2.8e5 }')" 1e-14
says 'reference' said 'extrapolated from cps9'
says 'reference' out/study.tab '# normal_resultant: reference 280000, given'
says 'singular pressure' out/study.tab 'cps9: the largest pressure, at (0, 0), an end of the contact surface, grows with every level'
for listing in out/*/ex3-pillar-in-ground.lst; do
   says "one solver on all levels, $listing" "$listing" '  sparse  '
   grep -q '  skyline  \|  banded  ' "$listing" && complain "$listing: another solver"
done
says 'soonest' out/study.tab '# 1 % of strain_energy'
says 'probes' out/study.tab '# half the delta moves strain_energy by'
says 'probes' out/study.tab '# half the eps moves strain_energy by'

# Nine-node elements from four-node ones: the same as a deck of them.
sed 's/CPE4/CPE9/' "$input/ex1-plate-on-rigid-support.inp" >nine.inp
run 0 nine.inp nine --digits 17 --quiet
"$atrito" study "$input/ex1-plate-on-rigid-support.inp" --levels 1 --elements cpe9 -o other --digits 17 --quiet || complain 'cpe9 of a deck of cpe4'
same_tables 'contact of cpe9' nine/contact.tab other/cpe9_0/contact.tab 1e-9
near 'energy of cpe9' "$(summary other/cpe9_0 strain_energy)" "$(summary nine strain_energy)" 1e-13

# A body without contact: what belongs to a pair is nan.
sed -e '/^\*SURFACE, NAME=SUPPORT/,/^OVER-BOTTOM, SUPPORT/d' -e '/^\*CONTACT PRINT/d' -e 's/^SPAN-RIGHT, 1/&\nOVER-BOTTOM, 2/' \
   "$input/ex1-plate-on-rigid-support.inp" >lone.inp
"$atrito" study lone.inp --levels 3 -o lone --quiet --plot || complain 'a study of a body without contact'
near 'resultant of no pair' "$(grep -c 'normal_resultant: no limit' lone/study.tab)" 1 0

# A probe is the run with half of the value: the deck says the same with --set. The words have two digits.
run 0 "$pillar" half --refine 0 --set delta=0.5e-9 --digits 17 --quiet
moved=$(awk '/^# half the delta moves strain_energy by/ { print $8 }' out/study.tab)
reference=$(awk '/^# strain_energy: reference/ { sub(",", "", $4); print $4 }' out/study.tab)
wanted=$(value "100*($(summary half strain_energy) - $(summary level-0 strain_energy))/$reference")
near 'what half the delta does' "$moved" "$(value "$wanted < 0 ? -($wanted) : $wanted")" "$(value "0.06*$moved")"

# Exact stick has no eps; a stick slope is probed by twice of it.
sed -e 's/^\*FRICTION, NONLOCAL/*FRICTION/' -e 's/^<nu>, <eps>, <rho>/<nu>, <slope>/' -e 's/^eps = 1e-4/slope = 1e7/' "$pillar" >steep.inp
"$atrito" study steep.inp --levels 3 --elements cps9 -o steep --quiet --digits 17 || complain 'a study with a stick slope'
run 0 steep.inp soft --refine 0 --digits 17 --quiet
run 0 steep.inp twice --refine 0 --set slope=2e7 --digits 17 --quiet
for quantity in strain_energy normal_resultant; do
   moved=$(awk -v q="$quantity" '/^# twice the stick slope moves/ { for (i = 1; i < NF; i++) if ($i == q) print $(i + 2) }' steep/study.tab)
   reference=$(awk -v q="$quantity:" '/: reference/ && $2 == q { sub(",", "", $4); print $4 }' steep/study.tab)
   wanted=$(value "100*($(summary twice $quantity) - $(summary soft $quantity))/$reference")
   near "what twice the stick slope does to $quantity" "$moved" "$(value "$wanted < 0 ? -($wanted) : $wanted")" "$(value "0.06*$moved")"
done

# The flat punch, against exact values: order 1 for both elements, since the singularity of the edge decides, and what is said of it.
# P/2 is 1 and p(0) a/P is 1/pi; the energy is half the work of the tractions on the cut sides: Westergaard's field of
# Z = -P/(pi cos w), sin w = z, by Simpson's rule, which the punch itself and the symmetry line add nothing to.
punch=$input/studies/flat-punch.inp
energy=$(awk '
   # s11, s22, s12 and the displacements at a place y < 0
   function field(x, y,    r1, r2, a, b, c, s, re, im, d, q, t, zr, zi, dr, di) {
      r1 = sqrt((x + 1)^2 + y*y); r2 = sqrt((x - 1)^2 + y*y)
      a = (r1 + r2)/2; b = (r1 - r2)/2                                   # cosh, sin
      s = -sqrt((a - 1)*(a + 1)); c = 1 - b*b; c = (c > 0) ? sqrt(c) : 0 # sinh, cos
      re = a*c; im = -b*s; d = re*re + im*im                             # cos w
      zr = -load/pi*re/d; zi = load/pi*im/d                              # Z
      q = re*re - im*im; t = 2*re*im                                     # cos^2 w
      dr = q*re - t*im; di = q*im + t*re; d = dr*dr + di*di              # cos^3 w
      q = -load/pi*(x*dr + y*di)/d; t = -load/pi*(y*dr - x*di)/d         # dZ/dz, with sin w = z
      s11 = zr - y*t; s22 = zr + y*t; s12 = -y*q
      u1 = (-(1 - 2*mu)*load/pi*atan2(b, c) - y*zi)/(2*G)
      u2 = ((2 - 2*mu)*load/pi*log(a - s) - y*zr)/(2*G) }
   BEGIN { pi = atan2(0, -1); load = 2; mu = 0.3; G = 1000/2.6; n = 4000
      for (i = 0; i <= n; i++) {
         w = (i == 0 || i == n) ? 1 : (i % 2) ? 4 : 2
         field(2, -2*i/n - (i == 0)*1e-14); sum += w*(s11*u1 + s12*u2)
         field(2*i/n, -2); sum -= w*(s12*u1 + s22*u2) }
      printf "%.12g", sum*2/n/3/2 }' </dev/null)
near 'flat punch: energy of the exact field' "$energy" 0.000597117798457 1e-15
"$atrito" study "$punch" --levels 4 --elements cpe4,cpe9 --reference normal_resultant=1 --reference strain_energy=$energy \
   -o out --digits 17 --quiet || complain 'flat punch'
for element in cpe4 cpe9; do
   near "flat punch, $element: order of the resultant" "$(value_of 3 $element normal_resultant_order)" 1 0.05
   near "flat punch, $element: order of the energy" "$(value_of 3 $element strain_energy_order)" 1 0.05
   says "flat punch, $element" out/study.tab "$element: the largest pressure, at (1, 0), an end of the contact surface, grows"
   says "flat punch, $element" out/study.tab ", $element: the error still falls, order 1"
done
says 'flat punch' out/study.tab '# 1 % of normal_resultant soonest: cpe'
says 'flat punch' out/study.tab '; a smooth solution has 1 (cpe4), 2 (cpe9). Where the meshes are fine enough to tell, singular points do that'
middle=$(awk '!/^#/ && $5*$5 < 1e-20 { print $8/2 }' out/cpe9_3/contact.tab)
near 'flat punch: p(0) a/P' "$middle" "$(value 'cos(0)/atan2(0, -1)')" 1e-3
# A soft penalty: the error stops at what it does, and this is said. Half of it moves the values by about half of the error.
"$atrito" study "$punch" --levels 5 --elements cpe9 --reference strain_energy=$energy --set delta=1e-4 -o out --digits 17 --quiet ||
   complain 'soft punch'
says 'soft punch' out/study.tab '# 1 % of strain_energy: in no run'
says 'soft punch' out/study.tab '# strain_energy, cpe9: the error stops falling at 19 %: half the delta moves it by'
# Regularised friction against the limit with eps = 0.
"$atrito" study "$punch" --levels 4 --elements cpe9 --reference shear_resultant --set nu=0.3 -o out --quiet || complain 'rough punch'
coulomb=$(awk '/^# shear_resultant: reference/ { sub(",", "", $4); print $4 }' out/study.tab)
"$atrito" study "$punch" --levels 4 --elements cpe9 --reference "shear_resultant=$coulomb" --set nu=0.3 --set eps=1e-4 -o out --quiet ||
   complain 'rough punch, eps'
says 'rough punch' out/study.tab '# shear_resultant, cpe9: the error stops falling at 16 %: half the eps moves it by'

# A smooth field: orders 2 and 4 of the energy, 1 and 2 of the estimate.
"$atrito" study "$input/studies/smooth-field.inp" --levels 5 --elements cpe4,cpe8,cpe9 --reference strain_energy=0.439428879465916 \
   -o out --digits 17 --quiet --plot || complain 'smooth field'
# The four lines of the legend, 18 of 205 pixels each, are below all points, however many powers of ten these cover.
lowest=$(awk '/^[0-9]/ && (!low || $5 < low) { low = $5 } END { print low }' out/plots/study.dat)
below 'legend below the points' "$(sed -n 's/^set yrange \[\(.*\):\(.*\)\];.*/\1 \2/p' out/plots/study.gp |
   awk -v v="$lowest" 'NR == 1 { print log($2/v)/log($2/$1) }')" 0.65
near 'smooth field, cpe4: order' "$(value_of 4 cpe4 strain_energy_order)" 2 0.1
near 'smooth field, cpe8: order' "$(value_of 4 cpe8 strain_energy_order)" 4 0.1
near 'smooth field, cpe9: order' "$(value_of 4 cpe9 strain_energy_order)" 4 0.1
says 'smooth field' out/study.tab '2 (cpe9) at the last level, as for a smooth solution'
sed 's/TYPE=CP\(.\)[0-9]/TYPE=CP\16/' "$input/studies/smooth-field.inp" >triangles.inp
"$atrito" study triangles.inp --levels 5 --elements cpe3,cpe6 --reference strain_energy=0.439428879465916 \
   -o out --digits 17 --quiet || complain 'smooth field of triangles'
near 'smooth field, cpe3: order' "$(value_of 4 cpe3 strain_energy_order)" 2 0.1
near 'smooth field, cpe6: order' "$(value_of 4 cpe6 strain_energy_order)" 4 0.1
says 'smooth field of triangles' out/study.tab '2 (cpe6) at the last level, as for a smooth solution'

# A quantity that the load prescribes tells nothing, and has no panel.
"$atrito" study "$input/ex1-plate-on-support.inp" --levels 3 -o out --quiet --plot || complain 'held'
says 'held' out/study.tab '# normal_resultant: 1.5 in every run, but for rounding'
says 'held' out/plots/study.gp 'multiplot layout 3,3'
says 'against the mesh' out/plots/study.gp '"study.dat" index 0 using 1:5 with linespoints'
says 'against displacements' out/plots/study.gp '"study.dat" index 0 using 2:4 with linespoints'
near 'side of an element' "$(awk '/^[0-9]/ { print $1; exit }' out/plots/study.dat)" "$(value_of 0 deck h)" 1e-5

# A history: the values of its end; a run that ends early has none.
sed 's/NX=8, NY=4/NX=2, NY=1/' "$here/../stability-limit/push.inp" >push.inp
"$atrito" study push.inp --levels 3 --set H=4 -o push --quiet || complain 'push'
for k in 0 1 2; do
   near "push, level $k" "$(awk -v k=$k '/^# columns:/ { for (i = 3; i <= NF; i++) at[$i] = i - 2 } !/^#/ && $1 == k { print $at["strain_energy"] }' push/study.tab)" \
      "$(awk '!/^#/ && $3 == "strain_energy" { v = $4 } END { print v }' "push/deck_$k/summary.tab")" 1e-15
done
sed 's/^\*STEP$/*STEP, INC=2/' push.inp >short.inp
"$atrito" study short.inp --levels 3 -o short --quiet >/dev/null 2>&1
near 'histories that end early' $? 3 0
[ -s short/deck_2/summary.tab ] || complain 'short: nothing is written'
awk '/^# columns:/ { for (i = 3; i <= NF; i++) at[$i] = i - 2 }
   !/^#/ { n++; if ($at["strain_energy"] !~ /nan/ || $at["exit"] != 3) bad = 1 } END { exit bad || n != 3 }' short/study.tab ||
   complain 'short: values of another time'

# Faults are told before anything is written.
for fault in '--levels 2 --elements cpe4' '--levels 2 --reference energy' '--levels 2 --reference strain_energy=x' '--elements cps4'; do
   # shellcheck disable=SC2086
   "$atrito" study "$pillar" $fault -o wrong >/dev/null 2>told
   near "$fault" $? 1 0
   absent wrong
done
finish
