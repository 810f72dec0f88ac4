. "$(dirname "$0")/../lib.sh"

# largest FILE COLUMN...: the largest size of some columns.
largest() {
   file=$1
   shift
   for name in "$@"; do column "$file" "$name"; done | awk '{ v = ($1 < 0) ? -$1 : $1; if (v > most) most = v; if ($1 ~ /n/) bad = 1 }
      END { print (bad || NR == 0) ? "none" : most + 0 }'
}

# Free expansion: no stress but what a plane without strain across it keeps, -E alpha rise = -210; on the circle none at all.
for type in CPE3 CPE4 CPE6 CPE8 CPE9 CPE4R CPE8R CPS3 CPS4 CPS6 CPS8 CPS9 CPS4R CPS8R CAX3 CAX4 CAX6 CAX8 CAX4R CAX8R CAX9; do
   sed "s/TYPE=CPE4/TYPE=$type/" "$here/plate.inp" >free.inp
   across=0
   growth=1e-3
   case $type in
   CPE*) across=-210; growth=1.3e-3 ;;
   CAX*) awk '/^\*BOUNDARY/ { print; getline; next } { print }' free.inp >circle.inp; mv circle.inp free.inp ;;
   esac
   run 0 free.inp free-$type --digits 17 --quiet
   # the blocked stress is E alpha rise/(1 - 2 mu) = 525
   below "$type, free: stresses in the plane" "$(largest free-$type/stress.tab s11 s22 s12)" 5.25e-10
   all_near "$type, free: across it" free-$type/stress.tab s33 $across 5.25e-10
   at=1
   case $type in CAX*) at=0 ;; esac
   field_near "$type, free" free-$type/nodes.tab u1 "$growth*(x - $at)" 1e-14
   field_near "$type, free" free-$type/nodes.tab u2 "$growth*y" 1e-14
   below "$type, free: estimated error in %" "$(summary free-$type error_estimate_percent)" 1e-6
done
run 0 free.inp free-refined --refine 1 --digits 17 --quiet
below 'refined, free: stresses' "$(largest free-refined/stress.tab s11 s22 s33 s12)" 5.25e-10
# warm before the step is as good as cold behind it: 20 to 120 degrees, 120 to 20
run 0 free.inp free-back --set T0=120 --set T1=20 --digits 17 --quiet
same_tables 'cooling is heating backwards' free-CAX9/nodes.tab free-back/nodes.tab 1e-12 u1=-1 u2=-1

# strains without stress are large, too
sed 's/TYPE=CPE4/TYPE=CPS4/' "$here/plate.inp" >large.inp
run 0 large.inp large --set T1=6000 --digits 17 --quiet
says 'strains of the temperature are large' large/large.lst 'W-LARGE'
run 0 large.inp small --set T1=4900 --digits 17 --quiet
grep -q W-LARGE small/large.lst && complain 'a strain of 0.0488 is large'

# Held at both ends: s11 = -E alpha rise/(1 - mu^2) (1 + mu) in plane strain, -E alpha rise in plane stress; s33 follows. The energy
# is s11^2/2E of the plane stress; in plane strain (s11^2 + s33^2 - 2 mu s11 s33)/2E; volume 2 x 1 x 0.5.
for type in CPE3 CPE4 CPE6 CPE8 CPE9 CPE4R CPE8R; do
   for form in dense sparse; do
      sed "s/TYPE=CPE4/TYPE=$type/" "$here/bar.inp" >bar.inp
      run 0 bar.inp bar-$type-$form --contact $form --digits 17 --quiet
      all_near "$type, held, $form" bar-$type-$form/stress.tab s11 -360 1e-9
      all_near "$type, held, $form" bar-$type-$form/stress.tab s33 -360 1e-9
      all_near "$type, held, $form" bar-$type-$form/stress.tab mises 360 1e-9
      near "$type, held, $form: strain energy" "$(summary bar-$type-$form strain_energy)" "$(value '360^2*1.4/420e3')" 1e-12
      near "$type, held, $form: work" "$(summary bar-$type-$form external_work)" 0 1e-12
   done
   sed "s/TYPE=CPE/TYPE=CPS/; s/TYPE=CPE4/TYPE=$type/" bar.inp >thin.inp
   run 0 thin.inp thin-$type --digits 17 --quiet
   all_near "$type thin, held" thin-$type/stress.tab s11 -252 1e-9
   all_near "$type thin, held" thin-$type/stress.tab s33 0 0
   near "$type thin, held: strain energy" "$(summary thin-$type strain_energy)" "$(value '252^2/420e3')" 1e-12
done
near 'reaction at the left end' "$(awk '!/^#/ && $3 > 0 { s += $3 } END { printf "%.17g", s }' bar-CPE9-dense/reactions.tab)" 180 1e-10
# a sweep over the temperature factors nothing anew
"$atrito" sweep "$here/bar.inp" --vary rise=50,100,200 -o warm --digits 17 --quiet 2>told || complain 'sweep over the temperature'
all_near 'sweep, 200 degrees' warm/rise_200/stress.tab s11 -720 1e-9
says 'no factorisation in a later run' warm/rise_200/bar.lst 'factorisations ................... 0'
# nothing but a unit of the temperature: 1/10 of the degrees, 10 times alpha
sed 's/^1.2e-5/1.2e-4/' "$here/bar.inp" >tenth.inp
run 0 tenth.inp tenth --set rise=10 --digits 17 --quiet
same_tables 'the unit of the temperature' tenth/stress.tab bar-CPE4-dense/stress.tab 1e-12

# A linear temperature leaves a thin free plate without stress: u is of the second degree, which six and nine nodes with straight
# sides have, and eight in parallelograms. --refine leaves the temperature between the nodes of the deck what it was.
for type in CPS6 CPS8 CPS9; do
   shape='s/^0.9, 1.1/0.9, 1.3/'
   [ $type = CPS8 ] && shape='s/^0.9, 1.1/0.8, 1.5/'
   sed "s/TYPE=CPE4/TYPE=$type/; /^ARC/d; $shape" "$here/plate.inp" >mesh.inp
   run 0 mesh.inp mesh --digits 17 --quiet
   awk 'NR == FNR { if (!/^#/) line[++n] = sprintf("%d, %.17g", $2, 30*$3 - 20*$4 + 50); next }
      /^\*BOUNDARY/ { print "*BOUNDARY\n1, 1, 2\n9, 2"; getline; getline; next }
      { print } /^\*TEMPERATURE/ { for (i = 1; i <= n; i++) print line[i]; getline }' mesh/nodes.tab mesh.inp >linear.inp
   for level in 0 1; do
      run 0 linear.inp linear-$type-$level --set T0=0 --refine $level --digits 17 --quiet
      below "$type, linear temperature, level $level: stresses" "$(largest linear-$type-$level/stress.tab s11 s22 s12)" 3e-9
   done
done

# Bimetal strip: curvature 6 (a2 - a1) rise (1 + m)^2/(h (3 (1 + m)^2 + (1 + m n)(m^2 + 1/(m n)))), m the ratio of the heights, n of E.
run 0 "$here/strip.inp" strip --digits 17 --quiet
near 'curvature of a bimetal strip' "$(awk '!/^#/ && $4 == 0 { u[$3 + 0] = $6 }
   END { printf "%.17g", (u[9.5] - 2*u[10] + u[10.5])/0.25 }' strip/nodes.tab)" \
   "$(value '6*1e-5*50*(5/3)^2/(3*(5/3)^2 + (1 + 1/3)*(4/9 + 3))')" 1e-9

# Shrink fits against Lame: bore 1.5 of the outer ring smaller by (1 + mu) alpha rise 1.5 with no strain across, or the inner one larger.
pressure() {
   awk -v d="$1" '
   function u(e, mu, a, b, inside, outside, r,   k) {      # plane strain; displacement of a ring at r
      e = e/(1 - mu*mu); mu = mu/(1 - mu); k = b*b - a*a
      return ((1 - mu)*(inside*a*a - outside*b*b)*r + (1 + mu)*(inside - outside)*a*a*b*b/r)/(e*k)
   }
   BEGIN { printf "%.17g", d/(u(2000, 0.2, 1.5, 2, 1, 0, 1.5) - u(1000, 0.3, 1, 1.5, 0, 1, 1.5)) }' </dev/null
}
p=$(pressure "$(value '1.2*1e-5*100*1.5')")
for form in dense sparse; do
   run 0 "$here/shrink.inp" shrink-$form --contact $form --digits 17 --quiet
   all_near "shrink fit, $form" shrink-$form/contact.tab pressure "$p" "$(value "4e-5*$p")"
   below "shrink fit, $form: equilibrium" "$(summary shrink-$form equilibrium_residual)" 1e-11
done
run 0 "$here/shrink.inp" shrink-fine --refine 1 --digits 17 --quiet
all_near 'shrink fit, refined' shrink-fine/contact.tab pressure "$p" "$(value "5e-6*$p")"
p=$(pressure "$(value '1.3*2e-5*60*1.5')")
for type in CAX4 CAX8 CAX9; do
   case $type in CAX4) tolerance=2e-2 ;; *) tolerance=1e-4 ;; esac
   sed "s/CAX8/$type/" "$here/tube.inp" >tube.inp
   run 0 tube.inp tube-$type --digits 17 --quiet
   all_near "shrink fit of $type" tube-$type/contact.tab pressure "$p" "$(value "$tolerance*$p")"
done

# CalculiX 2.20, every node with a temperature of its own: CPE8 agrees in 7 digits; its CAX8 is a wedge of 2 degrees.
heat() {
   awk '/^\*NODE,/ { on = 1; print; next } /^\*/ { on = 0 }
      on { split($0, a, ","); id[++n] = a[1] + 0; x[n] = a[2]; y[n] = a[3] }
      /^\*SOLID SECTION/ { print "*EXPANSION, ZERO=20.\n1.2e-5" }
      /^\*STEP/ { print "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nALL, 20." }
      { print }
      /^\*STATIC/ { print "*TEMPERATURE"; for (i = 1; i <= n; i++) printf "%d, %.10g\n", id[i], 60 + 300*x[i] - 200*y[i] }' "$1" |
      sed 's/^1000\.*, 0.3/1e5, 0.3/'
}
heat "$here/../eight-nodes/beam.inp" >beam.inp
heat "$here/../axisymmetric/bush.inp" >bush.inp
for scene in beam bush; do
   run 0 $scene.inp $scene --digits 17 --quiet
   set -- $(awk 'function size(v) { return v < 0 ? -v : v }
      NR == FNR { a[$1] = $2; b[$1] = $3; n++; next }
      !/^#/ && ($2 in a) { n--; if (size($5) > most) most = size($5); if (size($6) > most) most = size($6)
         if (size($5 - a[$2]) > d) d = size($5 - a[$2]); if (size($6 - b[$2]) > e) e = size($6 - b[$2]) }
      END { printf "%d %.17g %.17g", n, d/most, e/most }' "$here/$scene.ccx" $scene/nodes.tab)
   near "$scene: nodes that CalculiX has and atrito has not" "$1" 0 0
   case $scene in beam) tolerance=5e-7 ;; *) tolerance=2e-4 ;; esac
   below "$scene: largest difference from CalculiX along 1" "$2" $tolerance
   below "$scene: and along 2" "$3" 5e-7
done
says 'ZERO is told' beam/beam.lst 'ZERO'
finish
