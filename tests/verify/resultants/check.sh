. "$(dirname "$0")/../lib.sh"

# cell FILE ROW COLUMN: a value of a table.
cell() {
   column "$1" "$3" | sed -n "$2p"
}

# in_equilibrium FOLDER: every body of bodies.tab, and how many there are.
in_equilibrium() {
   below "$1: imbalance of a body" "$(awk '
      /^# columns:/ { for (i = 3; i <= NF; i++) place[$i] = i - 2; next }
      /^#/ { next }
      { rows++
        for (k = 1; k <= 3; k++) {
           what = (k == 1) ? "_fx" : (k == 2) ? "_fy" : "_moment"
           group = (k == 3) ? 2 : 1
           a[1] = $place["loads" what]; a[2] = $place["supports" what]; a[3] = $place["contact" what]
           sum = a[1] + a[2] + a[3]; if (sum < 0) sum = -sum
           if (sum > worst[group]) worst[group] = sum
           for (i = 1; i <= 3; i++) { d = (a[i] < 0) ? -a[i] : a[i]; if (d > largest[group]) largest[group] = d } } }
      END { if (rows == 0 || largest[1] == 0) { print "none"; exit }
         r = worst[1]/largest[1]
         # moments that are rounding everywhere have no scale of their own
         scale = (largest[2] > 1e-6*largest[1]) ? largest[2] : largest[1]
         if (worst[2]/scale > r) r = worst[2]/scale
         printf "%.17g", r }' "$1/bodies.tab")" 1e-9
}

# stack NAME ANGLE ROLES LENGTH FORCE [options]
stack() {
   name=$1
   awk -v a="$2" -v roles="$3" -v L="$4" -v F="$5" -f "$here/stack.awk" >"$name.inp"
   shift 5
   run 0 "$name.inp" "$name" --digits 17 --quiet "$@"
}

# stack_near NAME ANGLE ROLES: resultants by statics; the first joint is that of the two blocks.
stack_near() {
   name=$1
   cosine=$(value "cos($2*atan2(0, -1)/180)")
   sine=$(value "sin($2*atan2(0, -1)/180)")
   sign=$(value "1 - 2*$3")
   joints=$name/joints.tab
   near "$name: n of the upper joint" "$(cell "$joints" 1 n)" 2.8 1e-12
   near "$name: t of the upper joint" "$(cell "$joints" 1 t)" -0.5 1e-12
   near "$name: m of the upper joint" "$(cell "$joints" 1 m)" "$(value "-0.55*$sign")" 1e-11
   near "$name: n of the lower joint" "$(cell "$joints" 2 n)" 4.8 1e-12
   near "$name: t of the lower joint" "$(cell "$joints" 2 t)" -0.5 1e-12
   near "$name: m of the lower joint" "$(cell "$joints" 2 m)" -0.05 1e-11
   for row in 1 2; do
      # place in the axes of the stack
      if [ $row = 1 ]; then x=$(value "1 - 0.55/2.8"); y=1; else x=$(value "1 - 0.05/4.8"); y=0; fi
      near "$name: x of joint $row" "$(cell "$joints" $row x)" "$(value "$cosine*$x - $sine*$y")" 1e-11
      near "$name: y of joint $row" "$(cell "$joints" $row y)" "$(value "$sine*$x + $cosine*$y")" 1e-11
   done
   near "$name: load on the upper block along x" "$(cell "$name/bodies.tab" 2 loads_fx)" "$(value "0.5*$cosine + 2.8*$sine")" 1e-14
   near "$name: load on the upper block along y" "$(cell "$name/bodies.tab" 2 loads_fy)" "$(value "0.5*$sine - 2.8*$cosine")" 1e-14
   near "$name: its moment about the centre" "$(cell "$name/bodies.tab" 2 loads_moment)" 0.8 1e-14
   near "$name: moment of the contact" "$(cell "$name/bodies.tab" 2 contact_moment)" -0.8 1e-11
   in_equilibrium "$name"
}

for angle in 0 30 -120; do
   for roles in 0 1; do
      for form in dense sparse; do
         stack "stack_${angle}_${roles}_$form" $angle $roles 1 1 --contact $form
         stack_near "stack_${angle}_${roles}_$form" $angle $roles
      done
   done
done
[ "$(column stack_0_0_dense/joints.tab body_1 | tr '\n' ' ')" = '2 1 ' ] || complain 'body_1 is not the slave'
[ "$(column stack_0_0_dense/joints.tab body_2 | tr '\n' ' ')" = '1 0 ' ] || complain 'body_2 is not the master, or 0 a rigid one'
stack units 0 0 1000 0.001
same_tables 'bodies in other units' stack_0_0_dense/bodies.tab units/bodies.tab 1e-10 u1=1000 u2=1000 rotation=1 loads_fx=0.001 \
   loads_fy=0.001 loads_moment=1 supports_fx=1 supports_fy=1 supports_moment=1 contact_fx=0.001 contact_fy=0.001 contact_moment=1
same_tables 'joints in other units' stack_0_0_dense/joints.tab units/joints.tab 1e-10 n=0.001 t=0.001 m=1 x=1000 y=1000 opening=1000 \
   sliding=1000

# motions
run 0 "$here/rigid.inp" rigid --digits 17 --quiet
[ "$(column rigid/bodies.tab name | tr '\n' ' ')" = 'LOOSE_ONE HELD ' ] || complain 'the names of the bodies'
near 'u1 of the rigid motion' "$(cell rigid/bodies.tab 1 u1)" 0.3 1e-14
near 'u2 of the rigid motion' "$(cell rigid/bodies.tab 1 u2)" 0.2 1e-14
near 'its rotation' "$(cell rigid/bodies.tab 1 rotation)" 0.02 1e-14
near 'opening' "$(cell rigid/joints.tab 1 opening)" 0.32 1e-14
near 'sliding' "$(cell rigid/joints.tab 1 sliding)" 0.31 1e-14
[ "$(cell rigid/joints.tab 1 n) $(cell rigid/joints.tab 1 x)" = '0 nan' ] || complain 'an open joint has a place'
near 'u1 of the centre under pressure' "$(cell rigid/bodies.tab 2 u1)" 0.003 1e-13
near 'u2 of the centre under pressure' "$(cell rigid/bodies.tab 2 u2)" -0.005 1e-13
near 'the support' "$(cell rigid/bodies.tab 2 supports_fy)" 10 1e-11
in_equilibrium rigid

# many bodies, and the examples of the paper with supports of elastic bodies
for n in 9 20; do
   awk -v n=$n -v t=0.12 -v nu=1 -v across=2 -f "$here/../arches/arch.awk" | sed 's/^\*CONTACT PRINT/*BODY PRINT\n*JOINT PRINT/' >"arch$n.inp"
   run 0 arch$n.inp arch$n --digits 17 --quiet
   in_equilibrium arch$n
done
awk -v courses=4 -v len=8 -v nu=0.6 -v factor=0.2 -f "$here/../walls/wall.awk" | sed 's/^\*CONTACT PRINT/*BODY PRINT\n*JOINT PRINT/' >wall.inp
run 0 wall.inp wall --digits 17 --quiet
in_equilibrium wall
for example in ex1-plate-on-support ex2-two-plates ex3-pillar-in-ground; do
   sed 's/^\*END STEP/*BODY PRINT\n*JOINT PRINT\n*END STEP/' "$input/$example.inp" >"$example.inp"
   run 0 $example.inp $example --digits 17 --quiet
   in_equilibrium $example
   # n and t of a straight joint are the resultants of its pair
   near "$example: n" "$(cell $example/joints.tab 1 n)" "$(summary $example normal_resultant | sed -n 1p)" 1e-12
   near "$example: t" "$(cell $example/joints.tab 1 t)" "$(summary $example shear_resultant | sed -n 1p)" 1e-12
done

# sides that are arcs: loads on volumes and faces as the supports carry them, set by set
for type in CPE3 CPE4 CPS4R CPE6 CPS6 CPE8 CPS8R CPE9 CAX3 CAX4 CAX4R CAX6 CAX8 CAX8R CAX9; do
   case $type in CAX*) held='' push='BX, 7.' ;; *) held='RING-TOP, 1' push='GRAV, 3., 0.6, 0.8' ;; esac
   cat >ring.inp <<END
*HEADING
quarter of a ring
*BLOCK, TYPE=$type, ELSET=RING, NX=2, NY=3
1., 0.
2., 0.
0., 2.
0., 1.
ARC, LEFT, 0., 0.
ARC, RIGHT, 0., 0.
*MATERIAL, NAME=M
*ELASTIC
1e6, 0.3
*DENSITY
2.
*SOLID SECTION, ELSET=RING, MATERIAL=M
*BOUNDARY
RING-BOTTOM, 2
$held
*STEP
*STATIC
*DLOAD
RING, BY, -10.
RING, $push
*DSLOAD
RING-RIGHT, P, 1.
RING-LEFT, TRVEC, 2., 0., 1.
*END STEP
END
   sed -i '/^$/d' ring.inp
   run 0 ring.inp ring --digits 17 --quiet
   below "$type: imbalance of resultants.tab" "$(awk -v flat="${type##CAX*}" '
      /^#/ { next }
      { rows++; for (k = 4; k <= 6; k++) { sum[k] += $k; size = $k < 0 ? -$k : $k; if (size > most[k]) most[k] = size } }
      END { for (k = flat == "" ? 5 : 4; k <= (flat == "" ? 5 : 6); k++) {
               d = sum[k]/most[k]; if (d < 0) d = -d; if (d > worst) worst = d; if (!(most[k] > 1)) rows = 0 }
            if (!rows) print "none"; else printf "%.17g", worst }' ring/resultants.tab)" 1e-10
done

# only what is asked for is written, and compare knows it
grep -v '^\*BODY PRINT\|^\*JOINT PRINT' stack_0_0_dense.inp >unasked.inp
run 0 unasked.inp unasked --digits 17 --quiet
absent unasked/bodies.tab
absent unasked/joints.tab
for table in bodies joints; do
   rm -rf copy
   cp -r stack_0_0_dense copy
   "$atrito" compare stack_0_0_dense copy >compare.out || complain "compare: a copy"
   for k in 2 4 6 8; do
      # each number that is not zero, by 1e-5 of the largest of its column or more
      awk -v k=$k '/^#/ { print; next } { if ($(NF - k) + 0 != 0) { $(NF - k) = $(NF - k)*1.1; changed = 1 } print } END { exit !changed }' \
         stack_0_0_dense/$table.tab >copy/$table.tab || continue
      if "$atrito" compare stack_0_0_dense copy >compare.out; then complain "compare: $table, column $k from the end"; fi
   done
   rm copy/$table.tab
   if "$atrito" compare stack_0_0_dense copy >compare.out; then complain "compare: $table is missing"; fi
done
finish
