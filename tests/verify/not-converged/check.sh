. "$(dirname "$0")/../lib.sh"
# marked FOLDER: every table begins with the mark.
marked() {
   for table in contact summary nodes reactions stress iterations timing; do
      read -r first <"$1/$table.tab" || first=
      [ "$first" = '# NOT CONVERGED' ] || complain "$1/$table.tab begins with '$first'"
   done
}
# unmarked FOLDER: no table has it.
unmarked() {
   grep -l 'NOT CONVERGED' "$1"/*.tab && complain "$1 is marked"
}
cp "$here/post.inp" .
for lean in 0.3 0.6 1; do
   for nu in 0.5 1.5 3; do
      # this one is slow, but does not cycle
      [ $lean = 1 ] && [ $nu = 0.5 ] && continue
      echo '*CONTROLS, METHOD=PICARD' >controls.inp
      name=post-$lean-$nu
      run 3 post.inp "$name" --set px=0.5 --set lean=$lean --set nu=$nu
      says "$name" "$name.err" 'the loop cycles between 2 states'
      # the point that is unsettled, on the screen with the last iterations, and in the listing
      says "$name" "$name.err" '1 point is unsettled: node '
      says "$name" "$name.out" '1 point is unsettled in the last outer iterations'
      node=$(sed -n 's/.*1 point is unsettled: node \([0-9]*\).*/\1/p' "$name.err")
      grep -Eq "^  node $node [oc=+-]*(o[c=+-]|[c=+-]o)[oc=+-]*\$" "$name.out" || complain "$name: the screen does not name node $node"
      grep -Eq "^ +1 +[12] +$node +[^ ]+ +[^ ]+ +[oc=+-]+\$" "$name/post.lst" || complain "$name: the listing does not name node $node"
      last=$(awk '!/^#/ { print $2, $9 }' "$name/iterations.tab" | tail -n 1)
      grep -Eq "^ +${last% *} +[0-9]+ +[0-9]+ +[0-9]+ +[0-9]+ +" "$name.out" || complain "$name: the last outer iteration is not shown"
      [ "$(wc -l <"$name.out")" -le 24 ] || complain "$name: more than a screen"
      marked "$name"
      # the same folder again, now with a method that finds it
      echo '*CONTROLS, METHOD=ANDERSON' >controls.inp
      "$atrito" post.inp -o "$name" --set px=0.5 --set lean=$lean --set nu=$nu --digits 17 --quiet 2>"$name.err" ||
         { complain "$name ANDERSON"; cat "$name.err"; }
      unmarked "$name"
      # the map does not contract at the solution; one point is closed, so the estimate is what the loop measured
      says "$name" "$name.err" '[W-UNIQUE]'
      rates=$(sed -n 's/.*outer loop \([^,]*\), measured \([^)]*\)).*/\1 \2/p' "$name.err")
      near "$name contraction" "${rates% *}" "${rates#* }" "$(value "1e-2*${rates#* }")"
      near "$name open" "$(summary "$name" open_points)" 1 0
      near "$name slipping" "$(summary "$name" slip_points)" 1 0
      near "$name shear over nu p" "$(value "-1*($(summary "$name" shear_resultant))/($nu*($(summary "$name" normal_resultant)))")" 1 1e-8
      near "$name open gap" "$(column "$name/contact.tab" gap | awk '{ if ($1 < least) least = $1 } END { printf "%.17g", least }')" 0 0
      below "$name equilibrium" "$(summary "$name" equilibrium_residual)" 1e-10
   done
done
sed 's/^\*STATIC/*STATIC\n*CONTROLS, METHOD=PICARD, MAXIT=1/' "$input/ex1-plate-on-support.inp" >early.inp
run 3 early.inp early
marked early
[ "$(wc -l <early.out)" -le 24 ] || complain 'early: more than a screen'
# stopped before anything repeats: no point changes its state, and the one that is furthest off is named
sed 's/^\*STATIC/*STATIC\n*CONTROLS, METHOD=PICARD, MAXIT=5, TOLERANCE=1e-14/' "$input/ex1-plate-on-support.inp" >slow.inp
run 3 slow.inp slow --refine 1
marked slow
says slow slow.err 'did not converge in 5 iterations'
grep -Eq 'no point changes its state, the friction bound is off most at node [0-9]+;' slow.err || complain 'slow: no place is named'
grep -q unsettled slow.out && complain 'slow: points that have settled are said to be unsettled'
run 0 "$input/ex1-plate-on-support.inp" whole --quiet
unmarked whole
finish
