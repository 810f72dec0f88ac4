. "$(dirname "$0")/../lib.sh"

# stack FILE NU12 NU23 H: 4 x 0.5, 3.6 x 0.7 and 3 x 0.9, weight 2 per volume; the uppermost is pushed from the left.
stack() {
   {
      printf '*BLOCK, TYPE=CPE4, ELSET=B1, NX=20, NY=2\n0, 0\n4, 0\n4, 0.5\n0, 0.5\n'
      printf '*BLOCK, TYPE=CPE4, ELSET=B2, NX=18, NY=2\n0.2, 0.5\n3.8, 0.5\n3.8, 1.2\n0.2, 1.2\n'
      printf '*BLOCK, TYPE=CPE4, ELSET=B3, NX=15, NY=3\n0.4, 1.2\n3.4, 1.2\n3.4, 2.1\n0.4, 2.1\n'
      printf '*MATERIAL, NAME=M\n*ELASTIC\n5000, 0.3\n'
      for k in 1 2 3; do printf '*SOLID SECTION, ELSET=B%d, MATERIAL=M\n1\n' $k; done
      printf '*SURFACE INTERACTION, NAME=I12\n*FRICTION\n%s\n*SURFACE INTERACTION, NAME=I23\n*FRICTION\n%s\n' "$2" "$3"
      printf '*CONTACT PAIR, INTERACTION=I12\nB2-BOTTOM, B1-TOP\n*CONTACT PAIR, INTERACTION=I23\nB3-BOTTOM, B2-TOP\n'
      printf '*STEP\n*STATIC\n*BOUNDARY\nB1-BOTTOM, 1, 2\n*DLOAD\n'
      for k in 1 2 3; do printf 'B%d, BY, -2\n' $k; done
      printf '*DSLOAD\nB3-LEFT, P, %s\n*NODE PRINT\nU, RF\n*END STEP\n' "$(value "$4/0.9")"
   } >"$1"
}

# N23 = 2*3*0.9 = 5.4, N12 = 5.4 + 2*3.6*0.7 = 10.44
for form in dense sparse; do
   stack stands.inp 0.35 0.25 1.34
   run 0 stands.inp stands-$form --contact $form --quiet --digits 17
   near "$form: shear of the upper joint" "$(awk '!/^#/ && $2 == 2 && $3 == "shear_resultant" { print $4 }' stands-$form/summary.tab)" -1.34 1e-9
   near "$form: shear of the lower joint" "$(awk '!/^#/ && $2 == 1 && $3 == "shear_resultant" { print $4 }' stands-$form/summary.tab)" -1.34 1e-9
   # 0.25*5.4 = 1.35 is less than 0.35*10.44 = 3.654: far beyond both, the upper joint is told
   for push in 1.36 3 20; do
      stack upper.inp 0.35 0.25 $push
      run 4 upper.inp upper --contact $form --quiet
      absent upper
      says "$form, upper joint, H = $push" upper.err 'body B3'
      says "$form, upper joint, H = $push" upper.err 'along x1'
      says "$form, upper joint, H = $push" upper.err 'B3-BOTTOM on B2-TOP'
      says "$form, upper joint, H = $push" upper.err 'friction holds nu times N = 1.35 [F] at most (N = 5.4 [F])'
      grep -q 'rotate' upper.err && complain "$form, upper joint, H = $push: a rotation is told"
   done
   # 0.1*10.44 = 1.044 is less than 0.25*5.4 = 1.35: the two upper ones go together
   stack lower.inp 0.1 0.25 1.06
   run 4 lower.inp lower --contact $form --quiet
   says "$form, lower joint" lower.err 'bodies B'
   says "$form, lower joint" lower.err 'along x1'
   says "$form, lower joint" lower.err 'B2-BOTTOM on B1-TOP'
   says "$form, lower joint" lower.err '(N = 10.44 [F])'
done
finish
