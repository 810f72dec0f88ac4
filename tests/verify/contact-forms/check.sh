. "$(dirname "$0")/../lib.sh"

# block NAME TYPE NX NY X0 Y0 X1 Y1: turned by $turn degrees, lengths in units of $length.
block() {
   echo "*BLOCK, TYPE=$2, ELSET=$1, NX=$3, NY=$4"
   awk -v a="$turn" -v l="$length" -v x0="$5" -v y0="$6" -v x1="$7" -v y1="$8" 'BEGIN {
      a *= atan2(0, -1)/180
      split(x0 " " x1 " " x1 " " x0, x, " "); split(y0 " " y0 " " y1 " " y1, y, " ")
      for (i = 1; i <= 4; i++) printf "%.17g, %.17g\n", l*(x[i]*cos(a) - y[i]*sin(a)), l*(x[i]*sin(a) + y[i]*cos(a)) }' </dev/null
}

stress() { # a stress in the units of the deck
   value "($1)*$force/$length^2"
}

material() { # SET ...
   printf '*MATERIAL, NAME=M\n*ELASTIC\n%s, 0.25\n' "$(stress 3000)"
   for set in "$@"; do printf '*SOLID SECTION, ELSET=%s, MATERIAL=M\n%s\n' "$set" "$(value "0.8*$length")"; done
}

# body_force SETS FX FY: of each set, per volume, turned with the scene.
body_force() {
   for set in $1; do
      awk -v s="$set" -v a="$turn" -v u="$(value "$force/$length^3")" -v x="$2" -v y="$3" 'BEGIN { a *= atan2(0, -1)/180
         printf "%s, BX, %.17g\n%s, BY, %.17g\n", s, u*(x*cos(a) - y*sin(a)), s, u*(x*sin(a) + y*cos(a)) }' </dev/null
   done
}

interaction() { # LINEAR or HARD, LOCAL or NONLOCAL
   printf '*SURFACE INTERACTION, NAME=I\n'
   if [ "$1" = LINEAR ]; then
      printf '*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n%s\n' "$(value "2e5*$force/$length^3")"
   else
      printf '*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD\n'
   fi
   if [ "$2" = NONLOCAL ]; then
      printf '*FRICTION, NONLOCAL\n0.4, %s, %s\n' "$(value "1e-5*$length")" "$(value "0.7*$length")"
   else
      printf '*FRICTION\n0.4\n'
   fi
}

# layers FILE N LAW FRICTION: two layers of N x 5 elements of 0.1 x 0.1, the upper one pressed on its left third and on its last
# fifth and pulled along; a part between them opens.
layers() {
   {
      end=$(value "0.1*$2")
      block LOWER CPE4 "$2" 5 0 0 "$end" 0.5
      block UPPER CPE4 "$2" 5 0 0.5 "$end" 1
      material LOWER UPPER
      interaction "$3" "$4"
      printf '*CONTACT PAIR, INTERACTION=I\nUPPER-BOTTOM, LOWER-TOP\n'
      printf '*STEP\n*STATIC\n%s' "${controls:-}"
      printf '*BOUNDARY\nLOWER-BOTTOM, 1, 2\n'
      printf '*DSLOAD\nUPPER-LEFT, P, %s\n*DLOAD\n' "$(stress 0.5)"
      body_force UPPER 0 -0.31
      printf '*NODE PRINT\nU, RF\n*EL PRINT\nS\n*CONTACT PRINT\n*END STEP\n'
   } >"$1"
}

# wall FILE: five courses of blocks of 2 x 1, cut halves at the ends, head joints; own weight and a push of 0.2 of it.
wall() {
   {
      names=""
      bed=""
      head=""
      for row in 1 2 3 4 5; do
         y=$((row - 1))
         x=0
         k=1
         while [ "$x" -lt 8 ]; do
            width=2
            [ $((row % 2)) -eq 0 ] && [ "$x" -eq 0 ] && width=1
            [ $((x + width)) -gt 8 ] && width=1
            block "B$row$k" CPE4 "$((2*width))" 2 "$x" "$y" "$((x + width))" "$((y + 1))"
            names="$names B$row$k"
            [ "$k" -gt 1 ] && head="${head}B$row$k-LEFT, B$row$((k - 1))-RIGHT
"
            # the course below: the blocks whose tops this one stands on
            if [ "$row" -gt 1 ]; then
               below=1
               x1=0
               while [ "$x1" -lt 8 ]; do
                  w1=2
                  [ $(((row - 1) % 2)) -eq 0 ] && [ "$x1" -eq 0 ] && w1=1
                  [ $((x1 + w1)) -gt 8 ] && w1=1
                  if [ "$x" -lt $((x1 + w1)) ] && [ "$x1" -lt $((x + width)) ]; then
                     bed="${bed}B$row$k-BOTTOM, B$((row - 1))$below-TOP
"
                  fi
                  x1=$((x1 + w1))
                  below=$((below + 1))
               done
            fi
            x=$((x + width))
            k=$((k + 1))
         done
      done
      # shellcheck disable=SC2086 # a list of names
      material $names
      interaction HARD LOCAL
      printf '*CONTACT PAIR, INTERACTION=I\n%s%s' "$bed" "$head"
      printf '*STEP\n*STATIC\n*BOUNDARY\n'
      for k in 1 2 3 4; do echo "B1$k-BOTTOM, 1, 2"; done
      printf '*DLOAD\n'
      body_force "$names" 0.2 -1
      printf '*NODE PRINT\nU, RF\n*EL PRINT\nS\n*CONTACT PRINT\n*END STEP\n'
   } >"$1"
}

# both_forms NAME DECK [options]: the same tables but for the counts of iterations.
both_forms() {
   name=$1
   deck=$2
   shift 2
   for form in dense sparse; do
      run 0 "$deck" "$name-$form" --contact $form --digits 17 --proof off "$@"
      says "$name, $form: listing" "$name-$form/$(basename "$deck" .inp).lst" "$form, asked for"
      # the counts, what is left of the equilibrium, and what the condensed form alone proves
      grep -v 'picard_iterations\|linear_solves\|equilibrium_residual\|unique_up_to_nu\| index ' "$name-$form/summary.tab" >"$name-$form/rest"
      mv "$name-$form/rest" "$name-$form/summary.tab"
   done
   if ! "$atrito" compare "$name-dense" "$name-sparse" --rtol 1e-9 >"$name.compared"; then
      complain "$name: the forms differ"
      head -8 "$name.compared"
   fi
   tail -1 "$name.compared" | sed "s/^/$name: /"
}

turn=0
length=1
force=1

for deck in ex1-plate-on-support ex1-plate-on-rigid-support ex2-two-plates ex3-pillar-in-ground lessons/block-on-floor studies/flat-punch; do
   both_forms "$(basename $deck)" "$input/$deck.inp"
done
both_forms two-beams "$input/ex2-two-plates.inp" --set nu=0
both_forms pillar-refined "$input/ex3-pillar-in-ground.inp" --refine 1

# The dense form loses digits with the third power of the length (8.5 of 16 at 400): 300 is as long as it keeps 1e-9 in any build.
for n in 150 300; do
   for law in LINEAR HARD; do
      for friction in LOCAL NONLOCAL; do
         layers "layers-$n-$law-$friction.inp" $n $law $friction
         both_forms "layers-$n-$law-$friction" "layers-$n-$law-$friction.inp"
         [ "$(summary "layers-$n-$law-$friction-sparse" slip_points)" -gt 20 ] || complain "layers $n $law $friction: nothing slips"
      done
   done
done
# At T-joints some forces are not unique. Of the least ones some lie at their bounds though nothing slips, and whether such a point is
# told to stick or to slip is round-off: left out; the slip itself is compared.
wall wall.inp
for form in dense sparse; do
   run 0 wall.inp wall-$form --contact $form --digits 17
   says 'wall: not unique' wall-$form.err 'N-SHARED'
   column wall-$form/contact.tab slip >wall-$form.slip
   awk '/^# columns:/ { for (i = 3; i <= NF; i++) { if ($i == "slip") slip = i - 2; if ($i == "status") status = i - 2 } }
      !/^#/ { $slip = 0; $status = 0 } { print }' wall-$form/contact.tab >wall-$form.contact
done
below 'wall, slip' "$(paste wall-dense.slip wall-sparse.slip | awk '{ d = $1 - $2; if (d < 0) d = -d; if (d > worst) worst = d
   z = $1 < 0 ? -$1 : $1; if (z > most) most = z } END { if (most > 0) printf "%.3e", worst/most; else print "none" }')" 1e-9
same_tables 'wall, contact' wall-dense.contact wall-sparse.contact 1e-9
for table in nodes reactions stress; do
   same_tables "wall, $table" wall-dense/$table.tab wall-sparse/$table.tab 1e-9
done

# Turned by 30 degrees, and in units of a thousandth of the length and a thousand times the force.
# In other units the iterations are the same; of the wall, whose points at T-joints stick or slip by round-off, without the numbers of
# states. In a turned scene round-off is another one: a point
# without force may begin open or closed, so there the forces at the end are compared.
counts() { # FOLDER: of each solve; the residuals at the end are round-off
   case $1 in
      wall*) awk '!/^#/ { print $2, $3 }' "$1/iterations.tab" ;;
      *) awk '!/^#/ { print $2, $3, $7, $8, $9 }' "$1/iterations.tab" ;;
   esac
}
same_iterations() { # A B
   counts "$1" >counts.a
   counts "$2" >counts.b
   [ -s counts.a ] || complain "$1: no iterations"
   cmp counts.a counts.b || complain "$2: other iterations than $1"
}
for scene in "layers 150 LINEAR LOCAL" "layers 150 LINEAR NONLOCAL" "layers 150 HARD LOCAL" "layers 300 HARD NONLOCAL" wall; do
   name=$(echo "$scene" | tr ' ' '-')
   # shellcheck disable=SC2086 # a command, the file and its other words
   make_scene() { set -- "$1" $scene; command=$2; file=$1; shift 2; "$command" "$file" "$@"; }
   turn=30
   make_scene "$name-turned.inp"
   turn=0
   length=1e-3
   force=1e3
   make_scene "$name-units.inp"
   length=1
   force=1
   for other in turned units; do
      run 0 "$name-$other.inp" "$name-$other" --contact sparse --digits 17
      [ "$other" = turned ] || same_iterations "$name-sparse" "$name-$other"
   done
   s=$(value '1e3/1e-3^2')
   for folder in sparse units turned; do
      # places, slip and states aside
      awk '/^# columns:/ { for (i = 3; i <= NF; i++) at[$i] = i - 2; print "# columns: pair point pressure weighted_pressure shear" }
         !/^#/ { print $at["pair"], $at["point"], $at["pressure"], $at["weighted_pressure"], $at["shear"] }' \
         "$name-$folder/contact.tab" >"$name-$folder.forces"
   done
   same_tables "$name turned, forces" "$name-sparse.forces" "$name-turned.forces" 1e-9
   same_tables "$name in other units, forces" "$name-sparse.forces" "$name-units.forces" 1e-9 pressure="$s" \
      weighted_pressure="$s" shear="$s"
done

# What the program takes of itself, and says so.
form_in() { # FILE TEXT: of the entry, which may go on in the next line
   grep -A 1 'contact system [.]' "$1" | grep -qF "$2"
}
layers short.inp 60 LINEAR LOCAL
run 0 short.inp short
form_in short/short.lst 'dense, predicted cost' || complain 'short line: not dense by its cost'
layers long.inp 1500 LINEAR LOCAL
"$atrito" check long.inp >long.checked
form_in long.checked 'sparse, predicted cost' || complain 'long line: not sparse by its cost'
run 0 long.inp long
form_in long/long.lst 'sparse, predicted cost' || complain 'long line: listing'
controls='*CONTROLS, METHOD=PICARD
'
layers picard.inp 1500 LINEAR LOCAL
"$atrito" check picard.inp >picard.checked
form_in picard.checked 'dense, the method' || complain 'a method of the dense form: not dense'
"$atrito" short.inp -o wrong --contact sprse >wrong.out 2>wrong.err
near 'exit code of a wrong form' $? 1 0
says 'a wrong form' wrong.err 'auto, dense or sparse'
absent wrong
# a history that changes to a method of the other form, and back
run 0 "$here/methods.inp" methods --quiet --digits 17
form_in methods/methods.lst 'sparse, predicted cost' || complain 'the third step: not sparse by its cost'
sed '/^\*\* then back/,$d' "$here/methods.inp" >two-steps.inp
run 0 two-steps.inp two-steps --quiet --digits 17
form_in two-steps/two-steps.lst 'dense, the method' || complain 'the second step: not dense by its method'
grep -q 'N-METHOD' methods/methods.lst two-steps/two-steps.lst && complain 'a method that was taken is said not to be'
run 0 two-steps.inp asked --quiet --contact sparse
[ "$(grep -c 'N-METHOD' asked/two-steps.lst)" -eq 1 ] || complain 'a method that is not taken is not told once'
finish
