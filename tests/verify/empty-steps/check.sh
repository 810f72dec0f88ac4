. "$(dirname "$0")/../lib.sh"
# at_end FILE STEP: the rows of a table at the end of a step, without what tells which it is and what it has added
at_end() {
   awk -v step="$2" '/^# columns:/ { for (i = 3; i <= NF; i++) name[i - 2] = $i; n = NF - 2
         line = "# columns:"; for (i = 1; i <= n; i++) if (name[i] !~ /^(step|increment|slip_increment)$/) line = line " " name[i]; print line; next }
      /^#/ || $1 != step { next }
      { line = ""; for (i = 1; i <= n; i++) if (name[i] !~ /^(step|increment|slip_increment)$/) line = line " " $i; print line }' "$1"
}
# lifted NAME FRICTION OTHER PAIR OPTION ...: every step behind the second leaves all as it is
lifted() {
   name=$1
   sed "s|@FRICTION@|$2|; s|@OTHER@|$3|; s|@PAIR@|$4|" "$here/lifted.inp" >"$name.inp"
   shift 4
   run 0 "$name.inp" "$name" --digits 17 --quiet "$@"
   for table in contact nodes; do
      for step in 2 3 4 5; do at_end "$name/$table.tab" $step >"$name-$table-$step"; done
      for step in 3 4 5; do same_tables "$name, $table, step $step" "$name-$table-$step" "$name-$table-2" 1e-10; done
   done
   dissipated=$(awk '!/^#/ { print $1, $14 }' "$name/history.tab" | awk '$1 == 2 { before = $2 } END { printf "%.17g", $2 - before }')
   near "$name: dissipation" "$dissipated" 0 1e-12
}
open_with_shear() { # NAME STEP
   awk -v step="$2" '!/^#/ && $1 == step && $12 == 0 && $10 != 0 { n++ } END { print n + 0 }' "$1/contact.tab"
}
floor='*SURFACE, NAME=FLOOR, TYPE=SEGMENTS\nSTART, -1., 0.\nLINE, 4., 0.\n*RIGID BODY, ANALYTICAL SURFACE=FLOOR'
block='*BLOCK, TYPE=CPE4, ELSET=A, NX=7, NY=2\n-0.5, -1.\n3.5, -1.\n3.5, 0.\n-0.5, 0.\n*SOLID SECTION, ELSET=A, MATERIAL=M\n*BOUNDARY\nA-BOTTOM, 1, 2'
paper='*FRICTION, NONLOCAL, SLIP=INCREMENTAL\n0.5, 1e-4, 0.8'
exact='*FRICTION, NONLOCAL, SLIP=INCREMENTAL\n0.5, 0., 0.8'
for form in dense sparse; do
   lifted "paper-$form" "$paper" "$block" 'B-BOTTOM, A-TOP' --contact $form
   near "paper-$form: open points with friction" "$(open_with_shear "paper-$form" 2)" 3 0
   lifted "exact-$form" "$exact" "$floor" 'B-BOTTOM, FLOOR' --contact $form
   lifted "local-$form" '*FRICTION\n0.5' "$block" 'B-BOTTOM, A-TOP' --contact $form
   lifted "slope-$form" '*FRICTION\n0.5, 2000.' "$block" 'B-BOTTOM, A-TOP' --contact $form
   lifted "total-$form" '*FRICTION, SLIP=TOTAL\n0.5' "$block" 'B-BOTTOM, A-TOP' --contact $form
done
same_tables 'both forms' paper-dense-contact-2 paper-sparse-contact-2 1e-9
finish
