#!/bin/sh
# Pre-tension sections against closed forms: a bolted joint, which opens, and a tube.
. "$(dirname "$0")/../lib.sh"

# of FOLDER STEP COLUMN: of rigid.tab at the end of a step.
of() {
   awk -v step="$2" -v name="$3" '/^# columns:/ { for (i = 3; i <= NF; i++) at[$i] = i - 2 }
      !/^#/ && $1 == step { found = $at[name]; n++ } END { print n ? found : "none" }' "$1/rigid.tab"
}
# pressure FOLDER STEP: the least and the largest one, which are the same
pressure() {
   awk -v step="$2" '/^# columns:/ { for (i = 3; i <= NF; i++) at[$i] = i - 2 }
      !/^#/ && $1 == step { p = $at["pressure"]; if (!n++ || p < least) least = p; if (n == 1 || p > most) most = p }
      END { if (n && most - least <= 1e-12) printf "%.17g", most; else print "none" }' "$1/contact.tab"
}

# 1. Bolt kb = 125, sleeve kc = 150: tightened by F, then at that length pulled by P, the bolt has F + P kb/(kb + kc) and the sleeve
# F - P kc/(kb + kc), until that is nothing; then the bolt has P.
for case in dense sparse; do
   run 0 "$here/joint.inp" "joint-$case" --digits 17 --quiet --contact $case
   near "$case: taken out of the bolt" "$(of "joint-$case" 1 u1)" "$(value '0.03*(1/125 + 1/150)')" 1e-15
   near "$case: force of the bolt" "$(of "joint-$case" 1 r1)" 0.03 1e-13
   near "$case: pressure in the sleeve" "$(pressure "joint-$case" 1)" "$(value '0.03/1.5')" 1e-13
   near "$case: as long as it is" "$(of "joint-$case" 2 u1)" 4.4e-4 1e-17
   near "$case: force of the bolt, pulled" "$(of "joint-$case" 2 r1)" "$(value '0.03 + 0.02*125/275')" 1e-13
   near "$case: pressure, pulled" "$(pressure "joint-$case" 2)" "$(value '(0.03 - 0.02*150/275)/1.5')" 1e-13
   near "$case: force of the bolt, open" "$(of "joint-$case" 3 r1)" 0.08 1e-13
   near "$case: pressure, open" "$(pressure "joint-$case" 3)" 0 0
   # what is loosened is free to move: it is told, and the least motion from where it was leaves the middle of the head where it was
   says "$case: loosened" "joint-$case.err" 'W-IDLE'
   near "$case: loosened" "$(of "joint-$case" 4 u1)" -8e-5 1e-17
   near "$case: no force" "$(of "joint-$case" 4 r1)" 0 1e-15
done
same_tables 'both forms' joint-dense/rigid.tab joint-sparse/rigid.tab 1e-12

# 2. The forces of the section balance each other: nothing of them is in a resultant, and the load is the reaction of the wall alone.
loads=$(awk '/^   all / { s = s " " $2 } END { print s }' joint-dense/joint.lst)
[ "$loads" = ' 0 0.02 0.08 0' ] || complain "loads of the steps:$loads"
reactions() { # STEP
   awk -v step="$1" '/^# columns:/ { for (i = 3; i <= NF; i++) at[$i] = i - 2 } !/^#/ && $1 == step && $2 != 100 { s += $at["r1"]; n++ }
      END { if (n) printf "%.17g", s; else print "none" }' joint-dense/reactions.tab
}
near 'reactions, tightened' "$(reactions 1)" 0 1e-14
near 'reactions, pulled' "$(reactions 2)" -0.02 1e-14

# 3. The displacement says the same as the force; a normal that points the other way turns the sign of both.
sed 's/^100, 1, 0.03$/100, 1, 0./; /^tightened/,/^\*END STEP/s/^\*NODE PRINT$/*BOUNDARY\n100, 1, 1, 4.4e-4\n*NODE PRINT/' "$here/joint.inp" >moved.inp
run 0 moved.inp moved --digits 17 --quiet
near 'force by displacement' "$(of moved 1 r1)" 0.03 1e-13
sed 's/^1., 0., 0.$/-2., 0., 0./; s/^100, 1, 0.03/100, 1, -0.03/; s/^100, 1, 1, 4.4e-4/100, 1, 1, -4.4e-4/' "$here/joint.inp" >turned.inp
run 0 turned.inp turned --digits 17
grep -q 'W-CUT' turned.err || complain 'turned: no warning of a normal that points into the elements'
near 'turned: force' "$(of turned 2 r1)" "$(value '-(0.03 + 0.02*125/275)')" 1e-13

# 4. An inner tube: all of the circle counts.
for form in dense sparse; do
   run 0 "$here/ring.inp" ring-$form --digits 17 --quiet --contact $form
   near "ring, $form" "$(of ring-$form 1 u1)" "$(value '2/(1000*3.14159265358979324)')" 1e-15
done
run 0 "$here/ring.inp" ring-refined --digits 17 --quiet --refine 1
near 'ring, refined' "$(of ring-refined 1 u1)" "$(value '2/(1000*3.14159265358979324)')" 1e-15

# 5. Contact that is found does not find the two sides of the section.
sed 's/^\*CONTACT PAIR, INTERACTION=HARD/*CONTACT, DISTANCE=0.1/; s/^ONE, OTHER/*CONTACT INCLUSIONS, ALL EXTERIOR\n*CONTACT PROPERTY ASSIGNMENT\n, , HARD/' \
   "$here/joint.inp" >found.inp
run 0 found.inp found --digits 17 --quiet
near 'contact that is found: rows' "$(grep -vc '^#' found/contact.tab)" 8 0
near 'contact that is found: force' "$(of found 2 r1)" "$(value '0.03 + 0.02*125/275')" 1e-13
finish
