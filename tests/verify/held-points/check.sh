# check.sh ATRITO CASE_FOLDER INPUT_FOLDER
. "$(dirname "$0")/../lib.sh"
# hold NAME: the force along the belt at the held end over the pull of 1e5; of supports along their own axes from resultants.tab
hold() {
   awk -v t="$2" '/^# columns:/ { for (i = 3; i <= NF; i++) at[$i] = i - 2 } /^#/ { next }
      { for (i = 1; i <= NF; i++) if ($i == "HELD") { c = cos(t*atan2(1, 1)/45); s = sin(t*atan2(1, 1)/45); print -($at["fx"]*c + $at["fy"]*s)/1e5 } }' "$1/resultants.tab"
}
most() { column "$1/contact.tab" pressure | awk '$1 > m { m = $1 } END { printf "%.17g", m }'; }
# tension over radius and width: 1e5/0.55/0.2, to what six chords of a quarter resolve
p=$(value '1e5/0.55/0.2')
for type in CPS4 CPS9; do
   for turn in 0 30 57.3 90; do
      for digits in 6 10 17; do
         for form in dense sparse; do
            name=$type-$turn-$digits-$form
            awk -v n=6 -v turn=$turn -v digits=$digits -v type=$type -v free=1 -f "$here/belt.awk" </dev/null >"$name.inp"
            run 0 "$name.inp" "$name" --digits 17 --quiet --contact $form
            near "$name hold" "$(hold "$name" $turn)" 1 2e-3
            near "$name pressure" "$(most "$name")" "$p" "$(value "0.4*$p")"
         done
      done
   done
done
# a block that leans on a corner on a rigid floor: no push along the floor, whatever the slope
for angle in 0.01 0.2 0.8; do
   run 0 "$here/leaning.inp" "leaning-$angle" --set angle=$angle --quiet
   near "leaning $angle" "$(summary "leaning-$angle" normal_resultant)" 1 1e-6
   near "leaning $angle, along the floor" "$(column "leaning-$angle/reactions.tab" r1 | awk '{ s += $1 } END { printf "%.17g", s }')" 0 1e-9
done
# a plate aslant on the edge of a block: the edge pushes across the plate, whichever is the slave, from slopes of 0.01 on
for angle in 0.02 0.2; do
   for quadrature in NODAL MORTAR; do
      for roles in PLATE-BOTTOM,BASE-TOP BASE-TOP,PLATE-BOTTOM; do
         name=edge-$angle-$quadrature-$roles
         sed "s/^PLATE-BOTTOM,.*/$roles/; s/^\\*CONTACT PAIR.*/&, QUADRATURE=$quadrature/" "$here/edge.inp" >"$name.inp"
         run 0 "$name.inp" "$name" --set angle=$angle --quiet --digits 17
         near "$name" "$(awk '!/^#/ && $2 == 1 { printf "%.17g", -$3 }' "$name/reactions.tab")" \
            "$(awk -v a=$angle '!/^#/ { n += $8*$13 } END { printf "%.17g", n*sin(a) }' "$name/contact.tab")" 1e-9
      done
   done
done
# a quarter of a shrink fit: nothing is sheared along the fit, at the lines of symmetry neither
for type in CPE4 CPE8; do
   for form in dense sparse; do
      awk -v type=$type 'function ring(name, inside, outside, rows) {
            printf "*BLOCK, TYPE=%s, ELSET=%s, NX=4, NY=%d\n%s, 0\n%s, 0\n0, %s\n0, %s\n", type, name, rows, inside, outside, outside, inside
            print "ARC, RIGHT, 0, 0\nARC, LEFT, 0, 0" }
         BEGIN { ring("IN", "1.", "1.5", 20); ring("OUT", "1.5", "2.", 13)
            print "*MATERIAL, NAME=M\n*ELASTIC\n500., 0.3\n*SOLID SECTION, ELSET=IN, MATERIAL=M"
            print "*MATERIAL, NAME=N\n*ELASTIC\n1000., 0.3\n*SOLID SECTION, ELSET=OUT, MATERIAL=N\n*SURFACE INTERACTION, NAME=J\n*FRICTION\n0.2"
            print "*CONTACT PAIR, INTERACTION=J\nIN-RIGHT, OUT-LEFT\n*CLEARANCE, SLAVE=IN-RIGHT, MASTER=OUT-LEFT, VALUE=-1e-3"
            print "*BOUNDARY\nIN-BOTTOM, 2\nOUT-BOTTOM, 2\nIN-TOP, 1\nOUT-TOP, 1\n*STEP\n*STATIC\n*END STEP" }' </dev/null >fit.inp
      run 0 fit.inp fit --digits 17 --quiet --contact $form
      below "fit of $type, $form: shear over pressure" "$(value "$(summary fit max_abs_shear)/$(summary fit max_pressure)")" 0.01
   done
done
finish
