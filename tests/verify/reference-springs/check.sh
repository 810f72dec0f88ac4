#!/bin/sh
# Springs, equations and local axes at reference nodes of rigid surfaces; README.md has what is exact.
. "$(dirname "$0")/../lib.sh"

# deck NAME NAME=VALUE ...: of plate.awk.
deck() {
   deck_name=$1
   shift
   set -- "$@" end
   while [ "$1" != end ]; do set -- "$@" -v "$1"; shift; done
   shift
   awk "$@" -f "$here/plate.awk" </dev/null >"$deck_name.inp"
}
# both NAME NAME=VALUE ...: run in both forms, which must agree.
both() {
   deck "$@"
   for form in dense sparse; do run 0 "$1.inp" "$1-$form" --digits 17 --contact $form --quiet; done
   for name in pressure shear; do same_column "$1, both forms" "$1-dense" "$1-sparse" contact $name 1e-8; done
   for name in u2 moment; do same_column "$1, both forms" "$1-dense" "$1-sparse" rigid $name 1e-8; done
}
# rigid FOLDER ROW COLUMN: of a plate, in the rows of rigid.tab. joint FOLDER TABLE ROW COLUMN: of a table.
rigid() {
   column "$1/rigid.tab" "$3" | sed -n "$2p"
}
joint() {
   column "$1/$2.tab" "$4" | sed -n "$3p"
}
# same_column WHAT A B TABLE NAME TOLERANCE: a column of two tables, relative to its largest value.
same_column() {
   column "$2/$4.tab" "$5" >one
   column "$3/$4.tab" "$5" >other
   near "$1: $5" "$(paste one other | awk '{ d = $1 - $2; if (d < 0) d = -d; if (d > most) most = d; a = $1 < 0 ? -$1 : $1
      if (a > size) size = a; n++ } END { if (n) printf "%.17g", (size > 0) ? most/size : 0; else print "none" }')" 0 "$6"
}
load='*CLOAD/1001, 2, -10./1001, 1, 0.5/1001, 6, 2./1002, 2, -4.'

# 1. Springs of all kinds: their law, and the same as the loads that they are. By all solvers.
both springs 'held=*BOUNDARY/2001, 1, 2' "step=$load" "joint=*ELEMENT, TYPE=SPRING1, ELSET=TURN/9001, 1001/*SPRING, ELSET=TURN/6/50.
*ELEMENT, TYPE=SPRING2, ELSET=BETWEEN/9002, 1001, 1002/*SPRING, ELSET=BETWEEN/2/700.
*ELEMENT, TYPE=SPRINGA, ELSET=ALONG/9003, 2001, 1001/*SPRING, ELSET=ALONG/300."
turn=$(rigid springs-dense 1 ur)
u=$(rigid springs-dense 1 u2)
v=$(rigid springs-dense 2 u2)
near 'spring of a rotation: its moment' "$(joint springs-dense springs 1 force)" "$(value "50*$turn")" 1e-12
near 'spring between reference nodes' "$(joint springs-dense springs 2 force)" "$(value "700*($u - ($v))")" 1e-12
near 'spring along a line' "$(joint springs-dense springs 3 force)" "$(value "-300*($u)")" 1e-12
both loads "step=*CLOAD/1001, 2, $(value "-10 - 700*($u - ($v)) - 300*($u)")/1001, 1, 0.5/1001, 6, $(value "2 - 50*$turn")/1002, 2, $(value "-4 + 700*($u - ($v))")"
for table in contact rigid; do same_tables "springs or their forces: $table.tab" springs-dense/$table.tab loads-dense/$table.tab 1e-9; done
for solver in banded sparse; do
   run 0 springs.inp springs-$solver --digits 17 --contact dense --solver $solver --quiet
   same_tables "springs by $solver" springs-dense/contact.tab springs-$solver/contact.tab 1e-9
done

# 2. A soft spring of a rotation is none, a stiff one holds it; one between two rotations, or to the ground.
both held 'held=*BOUNDARY/1001, 6/1002, 6' "step=$load"
both stiff "step=$load" 'joint=*ELEMENT, TYPE=SPRING1, ELSET=TURN/9001, 1001/9002, 1002/*SPRING, ELSET=TURN/6/1e14'
same_tables 'a stiff spring holds' held-dense/contact.tab stiff-dense/contact.tab 1e-8
near 'its moment is the reaction' "$(joint stiff-dense springs 1 force)" "$(value "-($(rigid held-dense 1 moment))")" 1e-8
both ground 'held=*BOUNDARY/2001, 6/1002, 6' "step=$load" 'joint=*ELEMENT, TYPE=SPRING2, ELSET=TURN/9001, 2001, 1001/9002, 1002, 1001/*SPRING, ELSET=TURN/6/50.'
near 'spring to the ground' "$(joint ground-dense springs 1 force)" "$(value "50*$(rigid ground-dense 1 ur)")" 1e-11
near 'spring between two rotations' "$(joint ground-dense springs 2 force)" "$(value "-50*$(rigid ground-dense 1 ur)")" 1e-11

# 3. Equations among rigid surfaces alone, which give way nowhere: a gear and a lever; the same as the forces that they are.
both gear "step=$load" 'joint=*EQUATION/2/1001, 6, 1., 1002, 6, 2.'
near 'gear' "$(rigid gear-dense 1 ur)" "$(value "-2*($(rigid gear-dense 2 ur))")" 1e-13
moment=$(joint gear-dense equations 1 force)
both geared "step=*CLOAD/1001, 2, -10./1001, 1, 0.5/1001, 6, $(value "2 + ($moment)")/1002, 2, -4./1002, 6, $(value "2*($moment)")"
same_tables 'gear, or its moments' gear-dense/contact.tab geared-dense/contact.tab 1e-8
both lever "step=$load" 'joint=*EQUATION/2/1001, 6, 2., 1002, 2, 1.'
near 'lever' "$(rigid lever-dense 1 ur)" "$(value "-($(rigid lever-dense 2 u2))/2")" 1e-13
moment=$(joint lever-dense equations 1 force)
near 'lever: balance of the other plate' "$(awk '$2 == 2 && $3 == "normal_resultant" { print $4 }' lever-dense/summary.tab)" \
   "$(value "4 - ($moment)/2")" 1e-9
run 0 lever.inp lever-fine --refine 1 --digits 17 --quiet
near 'lever, refined' "$(rigid lever-fine 1 ur)" "$(value "-($(rigid lever-fine 2 u2))/2")" 1e-13

# 4. Local axes: a scene turned by any angle is the scene. One dof of a node held there, two, and forces along them.
steps='*CLOAD/1001, 2, -10./1001, 1, 0.5/1001, 6, 2./1002, 1, 0.2/*BOUNDARY/1002, 2, 2, -0.001//*CLOAD/1001, 2, -3./1001, 6, -1.'
both straight 'held=*BOUNDARY/1001, 1/1002, 2/1002, 6' "step=$steps"
for angle in 30 90 114.6; do
   c=$(value "cos($angle*atan2(0, -1)/180)")
   s=$(value "sin($angle*atan2(0, -1)/180)")
   both "turned-$angle" angle=$angle 'held=*BOUNDARY/1001, 1/1002, 2/1002, 6' "step=$steps" \
      "joint=*TRANSFORM, NSET=REFS/$c, $s, 0., $(value "-($s)"), $c"
   for name in pressure shear slip; do same_column "turned by $angle" straight-dense "turned-$angle-dense" contact $name 1e-9; done
   same_column "turned by $angle" straight-dense "turned-$angle-dense" rigid ur 1e-9
   near "turned by $angle: reaction" "$(value "$c*($(rigid "turned-$angle-dense" 2 r2)) - $s*($(rigid "turned-$angle-dense" 2 r1))")" \
      "$(rigid straight-dense 2 r2)" 1e-9
done
both both-held 'held=*BOUNDARY/1001, 1/1002, 1, 2' "step=*CLOAD/1001, 2, -10.//*BOUNDARY/1002, 2, 2, -0.002"
both both-turned angle=30 "joint=*TRANSFORM, NSET=REFS/$(value 'sqrt(3)'), 1., 0., -1., $(value 'sqrt(3)')" \
   'held=*BOUNDARY/1001, 1/1002, 1, 2' "step=*CLOAD/1001, 2, -10.//*BOUNDARY/1002, 2, 2, -0.002"
same_column 'both dofs along local axes' both-held-dense both-turned-dense contact pressure 1e-9

# 5. There and back in increments: the spring is what the plate's motion makes of it, and at the end of the way nothing is left.
for form in dense sparse; do
   deck "back-$form" friction=0. 'joint=*ELEMENT, TYPE=SPRING1, ELSET=UP/9001, 1001/*SPRING, ELSET=UP/2/700.' \
      'held=*BOUNDARY/1001, 1/1001, 6/1002, 1, 6' 'step=*CLOAD/1001, 2, -10.//*CLOAD/1001, 2, 5.'
   sed 's/^\*STATIC/&\n0.25, 1./; s/^U, RF/U, RF\n*CONTACT PRINT, FREQUENCY=1/' "back-$form.inp" >"steps-$form.inp"
   run 0 "steps-$form.inp" "steps-$form" --digits 17 --contact $form --quiet
   near "there and back, $form: lifted off" "$(rigid "steps-$form" 15 u2)" "$(value 5/700)" 1e-14
   near "there and back, $form: the spring's last force" "$(joint "steps-$form" springs 8 force)" 5 1e-12
   near "there and back, $form: the spring's first force" "$(joint "steps-$form" springs 1 force)" \
      "$(value "700*($(rigid "steps-$form" 1 u2))")" 1e-12
done

# 6. Nodes of elements as a rigid body: they move as one, wherever its reference node is and by every option that names them; a rigid
#    body of elements does what the drawn surface does, and both what the displacements do that it takes.
for form in dense sparse; do
   run 0 "$here/nodes.inp" "top-$form" --digits 17 --contact $form --quiet
   near "a rigid top, $form" "$(awk 'NR == FNR { if (!/^#/) { u = $4; v = $5; turn = $6 } next }
      !/^#/ && $4 == 1.5 { n++; d = $5 - (u - turn*($4 - 3)); e = $6 - (v + turn*($3 - 3)); if (d < 0) d = -d; if (e < 0) e = -e
         if (d > most) most = d; if (e > most) most = e } END { if (n == 13) print most + 0; else print "none" }' \
      "top-$form/rigid.tab" "top-$form/nodes.tab")" 0 1e-13
done
same_tables 'a rigid top, both forms' top-dense/nodes.tab top-sparse/nodes.tab 1e-8
run 0 "$here/nodes.inp" elsewhere --digits 17 --quiet --set rx=-7.5
same_column 'another reference node' top-dense elsewhere contact pressure 1e-8
sed 's/TIE NSET=U-TOP/ELSET=U/' "$here/nodes.inp" >rigid.inp
sed 's/TIE NSET=U-TOP/ANALYTICAL SURFACE=DRAWN/; s/^L-TOP, U-BOTTOM/L-TOP, DRAWN/; s/^L-BOTTOM, 1, 2/&\nU-TOP, 1, 2/' "$here/nodes.inp" >drawn.inp
for form in dense sparse; do
   for deck in rigid drawn; do run 0 $deck.inp $deck-$form --digits 17 --contact $form --quiet; done
   same_column "elements or a drawn surface, $form" drawn-$form rigid-$form contact pressure 1e-8
   for name in u1 u2 ur; do same_column "elements or a drawn surface, $form" drawn-$form rigid-$form rigid $name 1e-8; done
done

finish
