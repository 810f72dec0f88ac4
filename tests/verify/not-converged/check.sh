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
      marked "$name"
      # the same folder again, now with a method that finds it
      echo '*CONTROLS, METHOD=ANDERSON' >controls.inp
      "$atrito" post.inp -o "$name" --set px=0.5 --set lean=$lean --set nu=$nu --digits 17 --quiet 2>"$name.err" ||
         { complain "$name ANDERSON"; cat "$name.err"; }
      unmarked "$name"
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
run 0 "$input/ex1-plate-on-support.inp" whole --quiet
unmarked whole
finish
