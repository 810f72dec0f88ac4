. "$(dirname "$0")/../lib.sh"
expect_motion() { # NAME TEXT options
   name=$1
   text=$2
   shift 2
   run 4 "$here/block.inp" "$name" "$@"
   says "$name" "$name.err" 'body CRATE'
   says "$name" "$name.err" "$text"
   absent "$name"
}
run 0 "$here/block.inp" pressed --quiet
near 'pressed' "$(summary pressed normal_resultant)" 1 1e-12
expect_motion pulled 'free to move along x2' --set top=-1
says pulled pulled.err 'the contact opens (CRATE-BOTTOM on FLOOR), the load drives it with 1 [F]; it has no support'
expect_motion pushed 'free to move along x1' --set side=0.1
says pushed pushed.err 'it slides (CRATE-BOTTOM on FLOOR), the load drives it with H = 0.1 [F] and there is no friction; it has no support'
# a support that does not help is named
sed 's/^\*STEP/*BOUNDARY\n25, 1\n*STEP/' "$here/block.inp" >guided.inp
run 4 guided.inp guided --set top=-1
says guided guided.err 'its supports (node 25 along x1) do not prevent that'
sed 's/^\*STEP/*NSET, NSET=ASLANT\n25\n*TRANSFORM, NSET=ASLANT\n0.8, 0.6, 0., -0.6, 0.8, 0.\n*BOUNDARY\nASLANT, 1\n*STEP/' "$here/block.inp" >aslant.inp
run 4 aslant.inp aslant --set top=-1
says aslant aslant.err 'its supports along directions of their own, springs or equations (node 25) do not prevent that'
sed 's/^\*CONTACT PAIR/*FRICTION\n5.\n*CONTACT PAIR/' "$here/block.inp" >tip.inp
run 4 tip.inp tipped --set right=0.6
# about the corner at (1, 0), node 5; 0.6 at height 1 against the weight of 1 at 0.5
says tipped tipped.err 'free to rotate about (1, 0), which is node 5 of the contact,'
says tipped tipped.err 'the load turns it with 0.1 [F L] about that point'
absent tipped
run 0 tip.inp stands --set right=0.4 --quiet
sed -e '/^\*SURFACE, NAME=FLOOR/,/^CRATE-BOTTOM/d' "$here/block.inp" >alone.inp
run 4 alone.inp alone
says alone alone.err 'no support and no contact pair holds it'
# two bodies that fall together: nothing opens or slides
sed '/^SUPPORT, 2$/d' "$input/ex2-two-plates.inp" >falls.inp
run 4 falls.inp falls
says falls falls.err 'together under their loads: the loads drive them with 5000 [F], and no contact is in the way; their supports'
absent falls
absent alone
# turned ANGLE DIGITS: the block and its floor, turned, in numbers of so many digits
turned() {
   awk -v angle="$1" -v digits="$2" -f "$here/turned.awk" "$here/block.inp"
}
# 4e-10 of the weight along the floor are a load, in either form and however the scene is turned; nothing is none; where eight digits
# say how the floor slopes, it is what they leave and is taken out of the loads
for form in dense sparse; do
   run 4 "$here/block.inp" drives --set side=4e-10 --contact $form
   for angle in 30 57.3 114.6; do
      turned $angle 17 >exact.inp
      run 4 exact.inp "drives $angle" --set side=4e-10 --contact $form
      says "drives $angle $form" "drives $angle.err" 'the load drives it with H = 4e-10 [F]'
      run 0 exact.inp "rests $angle" --contact $form
      says "rests $angle $form" "rests $angle.err" 'W-IDLE'
      turned $angle 8 >digits.inp
      run 0 digits.inp "digits $angle" --set side=4e-10 --contact $form
      says "digits $angle $form" "digits $angle.err" 'W-IDLE'
      below "digits $angle $form: balance" "$(summary "digits $angle" equilibrium_residual)" 1e-12
   done
done
# a support that carried nothing leaves nothing behind, and a load that has just begun is told as it is at the end of its step
for form in dense sparse; do
   run 0 "$here/released.inp" released --contact $form
   says "released $form" released.err 'W-IDLE'
   sed 's/OP=NEW/&\n*CLOAD\n25, 1, 2/' "$here/released.inp" >moved.inp
   run 4 moved.inp moved --contact $form
   says "moved $form" moved.err 'the load drives it with H = 2e-5 [F] already (2 [F] at the end of the step) and there is no friction'
done
finish
