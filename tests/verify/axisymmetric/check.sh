# check.sh ATRITO CASE_FOLDER INPUT_FOLDER ERROR_NORMS
. "$(dirname "$0")/../lib.sh"
errors=$4
. "$here/../convergence/rates.sh"
rm -f lame.txt

# lame TYPE [FORMULATION]: radii 1 and 2, pressure 1 inside, held along the axis.
lame() {
   echo "*BLOCK, TYPE=$1, ELSET=C, NX=3, NY=2
1, 0
2, 0
2, 1
1, 1
*MATERIAL, NAME=M
*ELASTIC
1000, 0.3
*SOLID SECTION, ELSET=C, MATERIAL=M${2:-}
*BOUNDARY
C-BOTTOM, 2
C-TOP, 2
*STEP
*STATIC
*DSLOAD
C-LEFT, P, 1
*NODE PRINT
U, RF
*EL PRINT
S
*END STEP"
}

# Lame's cylinder: orders; the stresses of the finest level at the Gauss points, to h (1/96) or h^2 (1/48); the strain energy
# p pi a u(a) of the full circle
for type in CAX3 CAX4 CAX4R CAX6 CAX8 CAX8R CAX9; do
   lame $type >lame-$type.inp
   case $type in
   *[34] | *4R) l2=2 energy=1 finest=5 bound=2e-2 ;;
   *) l2=3 energy=2 finest=4 bound=4e-4 ;;
   esac
   for level in 0 1 2 3 4; do
      row lame.txt $type $level lame-$type.inp ring 1 2 1 0
   done
   orders lame.txt $type $l2 $energy
   run 0 lame-$type.inp lame-$type --refine $finest --digits 17 --quiet
   field_near "$type: s11" lame-$type/stress.tab s11 '1/3 - 4/(3*x*x)' $bound
   field_near "$type: s33" lame-$type/stress.tab s33 '1/3 + 4/(3*x*x)' $bound
   field_near "$type: s22" lame-$type/stress.tab s22 0.2 $bound
   near "$type: strain energy of the full circle" "$(summary lame-$type strain_energy)" \
      "$(value "atan2(0, -1)*1.3/3000*(0.4 + 4)")" 2e-7
done
markdown lame.txt

# Near mu = 1/2: the mean dilatation keeps four nodes from locking. u(a) = (1 + mu)/E ((1 - 2 mu) A a + A b^2/a), A = 1/3
for formulation in STANDARD BBAR; do
   lame CAX4 ", FORMULATION=$formulation" | sed 's/1000, 0.3/1000, 0.4999999/' >tight-$formulation.inp
   run 0 tight-$formulation.inp tight-$formulation --refine 2 --digits 17 --quiet
done
exact=$(value '1.4999999/1000*(2e-7/3 + 4/3)')
near 'BBAR: displacement inside' "$(column tight-BBAR/nodes.tab u1 | head -1)" "$exact" 2e-5
standard=$(column tight-STANDARD/nodes.tab u1 | head -1)
near 'STANDARD locks: the same, of the exact one' "$(value "$standard/$exact")" 0.3 0.3

# Reduced integration does not lock either; four nodes are as far from it as their mesh
for type in CAX4R CAX8R; do
   lame $type | sed 's/1000, 0.3/1000, 0.4999999/' >tight-$type.inp
   run 0 tight-$type.inp tight-$type --refine 2 --digits 17 --quiet
   near "$type: displacement inside" "$(column tight-$type/nodes.tab u1 | head -1)" "$exact" 4e-6
done

# patch TYPE INNER N SLAVE QUADRATURE BEHAVIOUR: two cylinders of radius 2 on each other, N elements in the lower, 3 in the upper.
patch() {
   echo "*BLOCK, TYPE=$1, ELSET=LOW, NX=$3, NY=2
$2, 0
2, 0
2, 1
$2, 1
*BLOCK, TYPE=$1, ELSET=UP, NX=3, NY=2
$2, 1
2, 1
2, 2
$2, 2
*MATERIAL, NAME=M
*ELASTIC
1000, 0.3
*SOLID SECTION, ELSET=LOW, MATERIAL=M
*SOLID SECTION, ELSET=UP, MATERIAL=M
*SURFACE INTERACTION, NAME=I
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=$6
*CONTACT PAIR, INTERACTION=I, QUADRATURE=$5"
   [ "$4" = up ] && echo "UP-BOTTOM, LOW-TOP" || echo "LOW-TOP, UP-BOTTOM"
   echo "*BOUNDARY
LOW-BOTTOM, 2
*STEP
*STATIC
*DSLOAD
UP-TOP, P, 10
*NODE PRINT
RF
*EL PRINT
S
*CONTACT PRINT
*END STEP"
}
# One pressure everywhere: stresses, pressures, and the force p pi R^2 on the support. The sparse form stops when forces change by
# 1e-10 of the largest, which a small weight at the axis makes more of as a pressure.
pressed() {
   within=1e-10
   [ -n "$7" ] && within=1e-8
   patch "$1" "$2" "$3" "$4" "$5" "$6" >pressed.inp
   run 0 pressed.inp pressed --digits 17 --quiet $7
   what="$1 from $2, $3 on 3, slave $4, $5, $(echo "$6" | head -1) $7"
   area=$(value "atan2(0, -1)*(4 - $2*$2)")
   all_near "$what: s22" pressed/stress.tab s22 -10 $within
   for name in s11 s33 s12; do all_near "$what: $name" pressed/stress.tab $name 0 $within; done
   all_near "$what: pressure" pressed/contact.tab pressure 10 $within
   near "$what: normal resultant" "$(summary pressed normal_resultant)" "$(value "10*$area")" $within
   near "$what: reactions" "$(column pressed/reactions.tab r2 | awk '{ s += $1 } END { printf "%.17g", s }')" "$(value "10*$area")" $within
}
for type in CAX3 CAX4 CAX4R CAX6 CAX8 CAX8R CAX9; do
   for inner in 0 1; do
      for slave in up low; do
         pressed $type $inner 3 $slave NODAL HARD ''
         pressed $type $inner 2 $slave MORTAR HARD ''
         pressed $type $inner 7 $slave MORTAR "PENALTY
1e-5" ''
      done
   done
   pressed $type 0 3 up NODAL "PENALTY
1e-5" '--contact sparse'
   pressed $type 0 7 low MORTAR HARD '--contact sparse'
done

# press TYPE N SLAVE QUADRATURE: a ring from 1 to 1.5 and another from 1.5 - d to 2 around it, held along the axis; closed form of
# plane strain (see verify/rings): the pressure on the inner ring.
d=1e-3
p=$(awk -v d=$d '
   function u(e, mu, a, b, inside, outside, r,   k) {
      e = e/(1 - mu*mu); mu = mu/(1 - mu); k = b*b - a*a
      return ((1 - mu)*(inside*a*a - outside*b*b)*r + (1 + mu)*(inside - outside)*a*a*b*b/r)/(e*k)
   }
   BEGIN { c = 1.5 - d; printf "%.17g", d/(u(2000, 0.2, c, 2, 1.5/c, 0, c) - u(1000, 0.3, 1, 1.5, 0, 1, 1.5)) }' </dev/null)
press() {
   echo "*BLOCK, TYPE=$1, ELSET=IN, NX=$2, NY=2
1, 0
1.5, 0
1.5, 1
1, 1
*BLOCK, TYPE=$1, ELSET=OUT, NX=$2, NY=$5
$(value "1.5 - $d"), 0
2, 0
2, 1
$(value "1.5 - $d"), 1
*MATERIAL, NAME=A
*ELASTIC
1000, 0.3
*MATERIAL, NAME=B
*ELASTIC
2000, 0.2
*SOLID SECTION, ELSET=IN, MATERIAL=A
*SOLID SECTION, ELSET=OUT, MATERIAL=B
*SURFACE INTERACTION, NAME=I
*CONTACT PAIR, INTERACTION=I, QUADRATURE=$4"
   [ "$3" = in ] && echo "IN-RIGHT, OUT-LEFT" || echo "OUT-LEFT, IN-RIGHT"
   echo "*BOUNDARY
IN-BOTTOM, 2
IN-TOP, 2
OUT-BOTTOM, 2
OUT-TOP, 2
*STEP
*STATIC
*CONTACT PRINT
*END STEP"
}
# The pressure on the slave, whose area differs between the roles: p r is the same.
fitted() {
   press $1 $2 $3 $4 $5 >fit.inp
   run 0 fit.inp fit --digits 17 --quiet
   factor=1
   [ $3 = out ] && factor=$(value "1.5/(1.5 - $d)")
   all_near "press fit $*: pressure" fit/contact.tab pressure "$(value "$factor*$p")" "$6"
   near "press fit $*: radial force" "$(summary fit normal_resultant)" "$(value "2*atan2(0, -1)*1.5*$p")" "$(value "5*$6")"
}
for slave in in out; do
   fitted CAX4 32 $slave NODAL 2 1e-3
   fitted CAX4 32 $slave MORTAR 3 1e-3
   fitted CAX8 8 $slave NODAL 2 1e-5
   fitted CAX9 8 $slave MORTAR 3 1e-5
done

# hertz TYPE SLAVE QUADRATURE N M RIGID LIMIT: a ball of radius 10 on a plane, elastic or rigid; a = 0.3, and N elements to x = 1.
# p(0) = 3 F/(2 pi a^2), a^3 = 3 F R/(4 E*); a from the mean radius of the pressure, 3 pi a/16.
hertz() {
   awk -v slave=$2 -f "$here/../hertz-roles/bodies.awk" -v type=$1 -v n=$4 -v m=$5 -v radius=0 -v rigid="$([ $6 = 1 ] && echo B)" \
      -v load="$([ $6 = 1 ] && echo 0.2518 || echo 0.1259)" -v quadrature=", QUADRATURE=$3" >ball.inp
   run 0 ball.inp ball --digits 17 --quiet
   found=$(awk -v rigid=$6 '!/^#/ { f += $13*$8; m += $13*$8*$5; if ($5*$5 < 1e-20) p = $8 }
      END { pi = atan2(0, -1); a = (3*f*10/(4*(rigid ? 1000 : 500)/0.91))^(1/3)
            printf "%.6f %.6f", p*2*pi*a*a/(3*f) - 1, 16/(3*pi)*m/f/a - 1 }' ball/contact.tab)
   near "ball $*: p(0)/p0 - 1" "${found% *}" 0 $7
   near "ball $*: a/a0 - 1" "${found#* }" 0 5e-3
}
# with four nodes the force on the axis is of first order only
hertz CAX4 A NODAL 32 32 1 3e-2
for type in CAX8 CAX9; do
   hertz $type A NODAL 32 32 1 5e-3
   for slave in A B; do
      hertz $type $slave NODAL 32 32 0 5e-3
      hertz $type $slave MORTAR 40 31 0 5e-3
   done
done

# Triangles and reduced integration are of second order on the axis, too, with a larger constant
for type in CAX6 CAX8R; do
   hertz $type A NODAL 64 64 1 2e-3
   hertz $type A MORTAR 64 60 0 5e-3
   hertz $type B NODAL 64 64 0 5e-3
done
hertz CAX4R A MORTAR 40 31 0 3e-2

# A plate of radius 10 and height 1/2 on its rim under a pressure: (5 + mu)/(1 + mu) q a^4/(64 D), less than 0.4 % of it shear
for type in CAX4R CAX8R; do
   echo "*BLOCK, TYPE=$type, ELSET=P, NX=20, NY=1
0, 0
10, 0
10, 0.5
0, 0.5
*MATERIAL, NAME=M
*ELASTIC
1000, 0.3
*SOLID SECTION, ELSET=P, MATERIAL=M
*STEP
*STATIC
*BOUNDARY
P-RIGHT, 2, 2
*DSLOAD
P-TOP, P, 1e-4
*NODE PRINT
U
*END STEP" >plate.inp
   run 0 plate.inp plate --digits 17 --quiet
   near "plate of one row of $type: deflection of Kirchhoff's" "$(awk '!/^#/ && $3 == 0 && $4 == 0 {
      printf "%.17g", -$6/(5.3/1.3*1e-4*1e4/64)*(1000*0.125/12/0.91) }' plate/nodes.tab)" 1 4e-3
done

# A ring that grows by 10.5 % inside, where the stress is best; nodes grow by 1.05, which is no small strain
for type in CAX3 CAX4 CAX4R CAX6 CAX8 CAX8R CAX9; do
   echo "*BLOCK, TYPE=$type, ELSET=C, NX=2, NY=2
10, 0
11, 0
11, 1
10, 1
*MATERIAL, NAME=M
*ELASTIC
1000, 0.3
*SOLID SECTION, ELSET=C, MATERIAL=M
*BOUNDARY
C-BOTTOM, 2
*STEP
*STATIC
*BOUNDARY
C-LEFT, 1, 1, 1.05
*END STEP" >grown.inp
   run 0 grown.inp grown --digits 17 --quiet
   says "$type: a ring that grows" grown.err 'W-LARGE'
   near "$type: the hoop strain that is told" "$(summary grown large_strain)" 0.103 2e-3
   sed 's/1.05$/0.05/' grown.inp >still.inp
   run 0 still.inp still --digits 17 --quiet
   ! grep -q 'W-LARGE' still.err || complain "$type: a ring that grows by half a percent is told"
done

# The two integrations in one body
patch CAX4 0 3 up NODAL HARD | sed 's/TYPE=CAX4, ELSET=LOW/TYPE=CAX4R, ELSET=LOW/' >mixed.inp
run 0 mixed.inp mixed --digits 17 --quiet --refine 1
all_near 'CAX4R below CAX4: s22' mixed/stress.tab s22 -10 1e-10
all_near 'CAX4R below CAX4: s33' mixed/stress.tab s33 0 1e-10
below 'CAX4R below CAX4: estimated error in %' "$(summary mixed error_estimate_percent)" 1e-7

# The same elements in CalculiX, of the largest displacement. It solves a wedge of 2 degrees, which costs radial displacements
# 1 - cos(1 degree) = 1.5e-4; along the axis they agree to the 7 digits that it prints.
sed 's/TYPE=CAX8/TYPE=CAX8R/' "$here/bush.inp" >bush8r.inp
for scene in bush disc bush6 bush8r; do
   deck=$here/$scene.inp
   [ $scene = bush8r ] && deck=bush8r.inp
   run 0 "$deck" $scene --digits 17 --quiet
   found=$(awk 'function size(v) { return v < 0 ? -v : v }
      NR == FNR { a[$1] = $2; b[$1] = $3; n++; next }
      !/^#/ && ($2 in a) { n--; if (size($5) > most) most = size($5); if (size($6) > most) most = size($6)
         if (size($5 - a[$2]) > d) d = size($5 - a[$2]); if (size($6 - b[$2]) > e) e = size($6 - b[$2]) }
      END { printf "%d %.17g %.17g", n, d/most, e/most }' "$here/$scene.ccx" $scene/nodes.tab)
   set -- $found
   near "$scene: nodes that CalculiX has and atrito has not" "$1" 0 0
   below "$scene: largest difference from CalculiX along the radius" "$2" 2e-4
   below "$scene: and along the axis" "$3" 5e-7
done
finish
