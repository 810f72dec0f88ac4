# check.sh ATRITO CASE_FOLDER INPUT_FOLDER
. "$(dirname "$0")/../lib.sh"
# at FOLDER STEP: u1 of the nodes of body B, which is the second block: least and largest
at() {
   awk -v step="$2" '/^# columns:/ { for (i = 3; i <= NF; i++) place[$i] = i - 2; next } /^#/ { next }
      $place["step"] == step && $place["x"] >= 1.0005 { u = $place["u1"]; if (!n++ || u < low) low = u; if (n == 1 || u > high) high = u }
      END { printf "%.17g %.17g", low, high }' "$1/nodes.tab"
}
for form in dense sparse; do
   for solver in skyline banded sparse; do
      name=$form-$solver
      # nothing acts: nothing moves, whatever gaps there are
      run 0 "$here/no-load.inp" "none-$name" --digits 17 --quiet --contact $form --solver $solver
      says "none $name" "none-$name.err" 'W-IDLE'
      all_near "none $name: u1" "none-$name/nodes.tab" u1 0 1e-17
      all_near "none $name: u2" "none-$name/nodes.tab" u2 0 1e-17
      all_near "none $name: pressure" "none-$name/contact.tab" pressure 0 0
      # all loads are taken away: what is left is none
      run 0 "$here/unload.inp" "unload-$name" --digits 17 --quiet --contact $form --solver $solver
      near "unload $name" "$(awk '!/^#/ && $1 == 2 { for (i = 5; i < NF; i++) s += ($i < 0) ? -$i : $i } END { print s + 0 }' "unload-$name/nodes.tab")" 0 1e-17
      # B is pressed on the floor: it stays, also when A is let go; A pushes it by .5 - .25. It is told though the last increment holds it
      run 0 "$here/drift.inp" "drift-$name" --digits 17 --quiet --contact $form --solver $solver
      says "drift $name" "drift-$name.err" 'W-IDLE'
      says "drift $name: which" "drift-$name.err" '(step 1, increment 1 and 2 more of those printed)'
      for step in 1 2; do
         near "drift $name $step" "$(at "drift-$name" $step | cut -d' ' -f1)" 0 1e-15
         near "drift $name $step" "$(at "drift-$name" $step | cut -d' ' -f2)" 0 1e-15
      done
      near "drift $name pushed" "$(at "drift-$name" 3 | cut -d' ' -f1)" 0.25 1e-12
      # where A was let go it stays
      near "drift $name left" "$(awk '!/^#/ && $1 == 2 && $2 == 1 { print $5 }' "drift-$name/nodes.tab")" 0.125 1e-12
   done
   same_tables "drift $form" drift-$form-skyline/nodes.tab drift-$form-sparse/nodes.tab 1e-12
done
# of a chain with more motions than a null space is sought of the block beside it stays where it was put
awk -v blocks=105 -f "$here/chain.awk" </dev/null >chain.inp
for form in dense auto; do
   run 0 chain.inp chain-$form --digits 17 --quiet --contact $form
   says "chain $form" chain-$form.err 'body LOOSE (node'
   for dof in 1 2; do
      near "chain $form: u$dof" "$(awk -v dof=$dof '!/^#/ && $1 == 2 && $2 > 420 { s += $(4 + dof)/4 } END { printf "%.17g", s }' chain-$form/nodes.tab)" \
         "$(value "0.1*$dof")" 1e-12
   done
done
# a wedge that lets its block out, in either form
for form in dense sparse; do
   run 0 "$here/wedge.inp" wedge-$form --contact $form
   says "wedge $form" wedge-$form.err 'W-IDLE'
   # with a little friction, too; with more it holds the block
   for nu in 0.05 0.3; do
      sed "s/^1.2163928946701518E-002$/&\n*FRICTION\n$nu/; s/PRESSURE-OVERCLOSURE=HARD/&\n*FRICTION\n$nu/" "$here/wedge.inp" >rough.inp
      run 0 rough.inp rough-$nu-$form --contact $form
   done
   says "wedge, 0.05 $form" rough-0.05-$form.err 'W-IDLE'
   all_near "wedge, 0.05 $form: pressure" rough-0.05-$form/contact.tab pressure 0 0
   near "wedge, 0.3 $form: W-IDLE" "$(grep -c W-IDLE rough-0.3-$form.err)" 0 0
done
same_tables "wedge that holds, both forms" rough-0.3-dense/contact.tab rough-0.3-sparse/contact.tab 1e-7
same_tables "drift, both forms" drift-dense-skyline/nodes.tab drift-sparse-sparse/nodes.tab 1e-12
finish
