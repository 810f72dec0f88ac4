. "$(dirname "$0")/../lib.sh"
mesh=$here/../mesh.awk

# material NAME E MU ELSET [THICKNESS]
material() {
   printf '*MATERIAL, NAME=%s\n*ELASTIC\n%s, %s\n*DENSITY\n2.\n*SOLID SECTION, ELSET=%s, MATERIAL=%s\n%s\n' "$1" "$2" "$3" "$4" "$1" "${5:-1}"
}

for type in CPE9 CPS9 CPE8 CPS8 CPE6 CPS6; do
   press='*DLOAD
ALL, P1, 3
ALL, P2, 3
ALL, P3, 3
ALL, P4, 3'
   # two triangles; the square's side 3 is face 2 of the upper one
   case $type in *6) press='*DLOAD
1, P1, 3
1, P2, 3
2, P2, 3
2, P3, 3' ;; esac
   { echo "*HEADING
One curved element under pressure from all sides"
   awk -v type=$type -v n=1 -v m=1 -v map=arched -f "$mesh"
   material A 1000 0.3 ALL 0.25
   echo "*BOUNDARY
1, 1, 2
3, 2
*STEP
*STATIC
$press
*NODE PRINT
RF
*EL PRINT
S
*END STEP"; } >curved-$type.inp
   run 0 curved-$type.inp curved-$type --digits 17 --quiet
   all_near "$type curved element s11" curved-$type/stress.tab s11 -3 3e-12
   all_near "$type curved element s22" curved-$type/stress.tab s22 -3 3e-12
   all_near "$type curved element s12" curved-$type/stress.tab s12 0 3e-12
   all_near "$type curved element r1" curved-$type/reactions.tab r1 0 1e-13
   all_near "$type curved element r2" curved-$type/reactions.tab r2 0 1e-13
   s33=0
   case $type in CPE*) s33=-1.8 ;; esac
   all_near "$type curved element s33" curved-$type/stress.tab s33 $s33 3e-12

   { echo "*HEADING
Constant strain in curved elements"
   awk -v type=$type -v n=3 -v m=3 -v map=arched -f "$mesh"
   material A 1000 0.25 ALL
   echo "*STEP
*STATIC
*BOUNDARY, FUNCTION
ALL-OUTLINE, 1, 1, 1e-3*x + 2e-3*y
ALL-OUTLINE, 2, 2, 3e-3*y - 1e-3*x
*NODE PRINT
U
*EL PRINT
S
*END STEP"; } >strain-$type.inp
   run 0 strain-$type.inp strain-$type --digits 17 --quiet
   field_near "$type constant strain u1" strain-$type/nodes.tab u1 '1e-3*x + 2e-3*y' 1e-15
   field_near "$type constant strain u2" strain-$type/nodes.tab u2 '3e-3*y - 1e-3*x' 1e-15
   # s11 = lambda (e11 + e22) + 2 G e11, lambda = G = 400 in plane strain, lambda = 800/3 in plane stress
   lambda=400
   case $type in CPS*) lambda=$(value 800/3) ;; esac
   all_near "$type constant strain s11" strain-$type/stress.tab s11 "$(value "$lambda*4e-3 + 0.8")" 1e-12
   all_near "$type constant strain s22" strain-$type/stress.tab s22 "$(value "$lambda*4e-3 + 2.4")" 1e-12
   all_near "$type constant strain s12" strain-$type/stress.tab s12 0.4 1e-12

   { echo "*HEADING
A column under its own weight"
   awk -v type=$type -v n=2 -v m=3 -v map=square -f "$mesh"
   material A 1000 0 ALL 0.5
   echo "*BOUNDARY
ALL-BOTTOM, 2
1, 1
*STEP
*STATIC
*DLOAD
ALL, GRAV, 10, 0, -1
*NODE PRINT
U, RF
*EL PRINT
S
*END STEP"; } >weight-$type.inp
   run 0 weight-$type.inp weight-$type --digits 17 --quiet
   field_near "$type weight s22" weight-$type/stress.tab s22 '-20*(1 - y)' 2e-11
   field_near "$type weight u2" weight-$type/nodes.tab u2 '-0.02*(y - y*y/2)' 1e-14
   near "$type weight on the support" "$(column weight-$type/reactions.tab r2 | awk '{ s += $1 } END { printf "%.17g", s }')" 10 1e-12
done

# blocks FOLDER LOW N UP N SLAVE DELTA QUADRATURE: two blocks of these element types with N elements along the joint.
blocks() {
   if [ "$6" = up ]; then pair="UP-BOTTOM, LOW-TOP"; else pair="LOW-TOP, UP-BOTTOM"; fi
   { echo "*HEADING
Two blocks"
   awk -v type="$2" -v n="$3" -v m=2 -v map=trapezoids -v elset=LOW -f "$mesh"
   awk -v type="$4" -v n="$5" -v m=2 -v map=trapezoids -v elset=UP -v first=1000 -v dy=1 -f "$mesh"
   material A 70000 0.2 LOW
   material B 210000 0.3 UP
   echo "*SURFACE INTERACTION, NAME=JOINT
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=PENALTY
$7
*CONTACT PAIR, INTERACTION=JOINT$8
$pair
*BOUNDARY
LOW-BOTTOM, 2
LOW-LEFT, 1
UP-LEFT, 1
*STEP
*STATIC
*DSLOAD
UP-TOP, P, 100
*NODE PRINT
U
*EL PRINT
S
*END STEP"; } >"$1.inp"
   run 0 "$1.inp" "$1" --digits 17 --quiet
   near "$1 resultant" "$(summary "$1" normal_resultant)" 100 1e-10
   below "$1 equilibrium" "$(summary "$1" equilibrium_residual)" 1e-10
}
# exact FOLDER DELTA
exact() {
   all_near "$1 pressure" "$1/contact.tab" pressure 100 1e-10
   all_near "$1 gap" "$1/contact.tab" gap "$(value "-100*$2")" 1e-15
   all_near "$1 s22" "$1/stress.tab" s22 -100 1e-10
   all_near "$1 s11" "$1/stress.tab" s11 0 1e-10
   all_near "$1 s12" "$1/stress.tab" s12 0 1e-10
}
for delta in 0 1e-8; do
   for slave in up low; do
      for type in CPE4 CPE9 CPS9 CPE8 CPS8 CPE3 CPS3 CPE6 CPS6; do
         blocks $type-$slave-$delta $type 4 $type 4 $slave $delta ""
         exact $type-$slave-$delta $delta
      done
   done
   blocks nine-on-four-$delta CPE4 3 CPE9 3 up $delta ", QUADRATURE=NODAL"
   exact nine-on-four-$delta $delta
   blocks nine-under-four-$delta CPE9 3 CPE4 3 low $delta ", QUADRATURE=NODAL"
   exact nine-under-four-$delta $delta
done

# Faces of eight and of nine nodes are the same.
blocks eight-on-nine CPE9 4 CPE8 4 up 0 ""
exact eight-on-nine 0
blocks eight-under-nine CPE8 4 CPE9 4 low 0 ", QUADRATURE=NODAL"
exact eight-under-nine 0
# So are those of triangles.
for slave in up low; do
   blocks six-on-nine-$slave CPE9 4 CPE6 4 $slave 0 ""
   exact six-on-nine-$slave 0
   blocks three-under-four-$slave CPE3 4 CPE4 4 $slave 0 ""
   exact three-under-four-$slave 0
done
# Sides that do not match, segment by segment.
for slave in up low; do
   blocks eight-mortar-$slave CPE8 4 CPE8 6 $slave 0 ", QUADRATURE=MORTAR"
   exact eight-mortar-$slave 0
done

# What NODAL does on sides that do not match: resultant and equilibrium hold, the stress does not.
measure() {
   blocks "$@" 0 ", QUADRATURE=NODAL"
   awk -v what="$1" '!/^#/ { d = $7 + 100; if (d < 0) d = -d; if (d > worst) worst = d }
      END { printf "%s: largest error of s22 %.3f of p\n", what, worst/100 }' "$1/stress.tab"
}
measure four-2-to-3-fine-slave CPE4 4 CPE4 6 up
measure four-2-to-3-coarse-slave CPE4 4 CPE4 6 low
measure nine-2-to-3-fine-slave CPE9 4 CPE9 6 up
measure nine-2-to-3-coarse-slave CPE9 4 CPE9 6 low
measure four-slave-on-nine-node-by-node CPE9 2 CPE4 4 up
measure nine-slave-on-four-node-by-node CPE9 2 CPE4 4 low
measure four-slave-on-nine-equal-elements CPE9 2 CPE4 2 up

# hill TYPE N SLAVE
for type in CPE9 CPS9 CPE8 CPS8 CPE6 CPS6; do
   for n in 1 2 5; do
      for slave in up low; do
         name=hill-$type-$n-$slave
         if [ $slave = up ]; then pair="UP-BOTTOM, LOW-TOP"; else pair="LOW-TOP, UP-BOTTOM"; fi
         { echo "*HEADING
A curved joint under pressure from all sides"
         awk -v type=$type -v n=$n -v m=2 -v map=hill -v elset=LOW -f "$mesh"
         awk -v type=$type -v n=$n -v m=2 -v map=valley -v elset=UP -v first=1000 -v dy=1 -f "$mesh"
         material A 1000 0.3 LOW
         material B 1000 0.3 UP
         echo "*SURFACE INTERACTION, NAME=JOINT
*CONTACT PAIR, INTERACTION=JOINT
$pair
*BOUNDARY
LOW-BOTTOM, 2
LOW-LEFT, 1
UP-LEFT, 1
*STEP
*STATIC
*DSLOAD
UP-TOP, P, 100
UP-RIGHT, P, 100
LOW-RIGHT, P, 100
*EL PRINT
S
*END STEP"; } >"$name.inp"
         run 0 "$name.inp" "$name" --digits 17 --quiet
         all_near "$name pressure" "$name/contact.tab" pressure 100 1e-10
         all_near "$name s11" "$name/stress.tab" s11 -100 1e-10
         all_near "$name s22" "$name/stress.tab" s22 -100 1e-10
         # arc length of y = 0.8 x (1 - x) over 0..1: (sqrt(1 + v^2) + asinh(v)/v)/2 with v = 0.8
         near "$name arc length" "$(column "$name/contact.tab" s | tail -n 1)" \
            "$(value "(sqrt(1.64) + log(0.8 + sqrt(1.64))/0.8)/2")" 1e-14
      done
   done
done
finish
