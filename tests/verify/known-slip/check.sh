. "$(dirname "$0")/../lib.sh"
# frame FOLDER COLUMN STEP INCREMENT: of history.tab
frame() {
   awk -v name="$2" -v step="$3" -v increment="$4" '/^# columns:/ { for (i = 3; i <= NF; i++) at[$i] = i - 2 }
      !/^#/ && $1 == step && $2 == increment { print $at[name] }' "$1/history.tab"
}
# more FOLDER STEP INCREMENT: what an increment adds to the dissipation
more() {
   value "$(frame "$1" dissipation "$2" "$3") - $(frame "$1" dissipation "$2" $(($3 - 1)))"
}
# deck FILE NAME=TEXT ...: fills a deck in; \n in a text begins a line
deck() {
   filled=$1
   shift
   for part; do filled=$(printf '%s' "$filled" | sed "s|@${part%%=*}@|${part#*=}|"); done
   printf '%s\n' "$filled"
}

# The side of a block is dragged: on the plateaus all points slide with nu p against the motion, nu N = 10 together, and dissipate nu N
# times the way. Where nothing moves nothing changes.
drag() { # NAME TYPE FRICTION OPTION ...
   name=$1
   deck "$(cat "$here/drag.inp")" "TYPE=$2" "FRICTION=$3" >"$name.inp"
   shift 3
   run 0 "$name.inp" "$name" --digits 17 --quiet "$@"
   for at in '2 3 -10 0.25' '2 4 -10 0.25' '3 5 10 0.4' '5 2 10 0.1'; do
      # shellcheck disable=SC2086
      set -- $at
      near "$name, step $1 increment $2: force" "$(frame "$name" shear_resultant "$1" "$2")" "$3" 1e-9
      near "$name, step $1 increment $2: dissipation" "$(more "$name" "$1" "$2")" "$4" 1e-9
      near "$name, step $1 increment $2: points that stick" "$(frame "$name" stick "$1" "$2")" 0 0
   done
   near "$name, it stays: force" "$(frame "$name" shear_resultant 4 1)" 10 1e-9
   near "$name, it stays: dissipation" "$(value "$(frame "$name" dissipation 4 1) - $(frame "$name" dissipation 3 5)")" 0 1e-14
}
drag exact CPE4 '*FRICTION\n0.5' --contact dense
drag sparse CPE4 '*FRICTION\n0.5' --contact sparse
drag slope CPE8 '*FRICTION\n0.5, 5000.' --contact sparse
drag paper CPE3 '*FRICTION, NONLOCAL, SLIP=INCREMENTAL\n0.5, 1e-3, 0.' --contact dense
same_tables 'both forms' exact/contact.tab sparse/contact.tab 1e-9

# Under forces that stay, and to one side, the way does not matter: one increment, four of them, or two steps.
at_end() { # NAME STEP: the contact at the end of a step, without what tells of increments
   echo '# columns: point gap pressure shear slip status'
   awk -v step="$2" '!/^#/ && $1 == step { line[$3] = $3 " " $7 " " $8 " " $10 " " $11 " " $12; n = $3 }
      END { for (i = 1; i <= n; i++) print line[i] }' "$1/contact.tab"
}
for name in exact slope paper; do
   sed 's/^0.25, 1[.]$/1., 1./' $name.inp >$name-once.inp
   awk '$0 == "there" { print "half of the way\n*STATIC\n*BOUNDARY\nB-LEFT, 1, 1, 0.04\n*END STEP\n*STEP" } { print }' $name.inp >$name-twice.inp
   for way in once twice; do run 0 $name-$way.inp $name-$way --digits 17 --quiet; done
   at_end $name 2 >$name.there
   at_end $name-once 2 >$name-once.there
   at_end $name-twice 3 >$name-twice.there
   same_tables "$name: the way at once" $name-once.there $name.there 1e-9
   same_tables "$name: the way in two steps" $name-twice.there $name.there 1e-9
done

# All of a side is carried: t, the work and the states are known at every increment. An elastic slip of 2.5e-3 is lost at the
# beginning, twice of it at the turn; half of the bound halves the friction, which the whole one does not bring back.
carry() { # NAME ELASTIC FRICTION OTHER PAIR AT-LAST OPTION ...
   name=$1
   elastic=$2
   again=$6
   deck "$(cat "$here/carried.inp")" "FRICTION=$3" "OTHER=$4" "PAIR=$5" >"$name.inp"
   shift 6
   run 0 "$name.inp" "$name" --digits 17 --quiet "$@"
   k=0
   for at in "1 1 0 0" "2 1 -10 0.025-$elastic" "2 4 -10 0.1-$elastic" "3 1 10 0.14-3*$elastic" "3 5 10 0.3-3*$elastic" \
      "4 1 10 0.3-3*$elastic"; do
      # shellcheck disable=SC2086
      set -- $at
      near "$name, step $1 increment $2: force" "$(frame "$name" shear_resultant "$1" "$2")" "$3" 1e-9
      near "$name, step $1 increment $2: dissipation" "$(frame "$name" dissipation "$1" "$2")" "$(value "10*($4)")" 1e-9
   done
   near "$name: half of the pressure" "$(frame "$name" shear_resultant 5 1)" 5 1e-9
   near "$name: the whole again" "$(frame "$name" shear_resultant 6 1)" "$again" 1e-9
   near "$name: points that do not slide" "$(awk '!/^#/ && $1 > 1 && $1 < 6 && $12 != 2' "$name/contact.tab" | wc -l)" 0 0
}
floor='*SURFACE, NAME=FLOOR, TYPE=SEGMENTS\nSTART, <-c>, <-s>\nLINE, <4*c>, <4*s>\n*RIGID BODY, ANALYTICAL SURFACE=FLOOR'
block='*BLOCK, TYPE=CPE4, ELSET=A, NX=4, NY=1\n<s>, <-c>\n<2*c+s>, <2*s-c>\n<2*c>, <2*s>\n0., 0.\n*SOLID SECTION, ELSET=A, MATERIAL=M\n*BOUNDARY\nA-TOP, 1, 2'
exact='*FRICTION\n0.5'
slope='*FRICTION\n0.5, 2000.'
paper='*FRICTION, NONLOCAL, SLIP=INCREMENTAL\n0.5, 2.5e-3, 0.6'
for angle in 0. 57.3; do
   carry "exact-$angle" 0 "$exact" "$floor" 'B-BOTTOM, FLOOR' 5 --set "angle=$angle"
   carry "slope-$angle" 0.0025 "$slope" "$floor" 'B-BOTTOM, FLOOR' 5 --set "angle=$angle"
   carry "paper-$angle" 0.0025 "$paper" "$floor" 'B-BOTTOM, FLOOR' 10 --set "angle=$angle"
   carry "on-block-$angle" 0 "$exact" "$block" 'B-BOTTOM, A-TOP' 5 --set "angle=$angle"
   carry "under-block-$angle" 0.0025 "$slope" "$block" 'A-TOP, B-BOTTOM' 5 --set "angle=$angle"
done

# The side is held over a floor that moves, or by equations with a grip that moves it over a floor that does not: the same friction, in
# the steps that move nothing as well.
hold_side() { # NAME BLOCK FRICTION HOLD MOVED WAY ELASTIC OPTION ...
   name=$1
   way=$6
   elastic=$7
   deck "$(cat "$here/held.inp")" "BLOCK=$2" "FRICTION=$3" "HOLD=$4" "MOVED=$5" >"$name.inp"
   shift 7
   run 0 "$name.inp" "$name" --digits 17 --quiet --set "way=$way" "$@"
   for at in '1 1 0 0' "2 4 10 0.1-$elastic" "3 1 -10 0.14-3*$elastic" "3 5 -10 0.3-3*$elastic" "4 1 -10 0.3-3*$elastic"; do
      # shellcheck disable=SC2086
      set -- $at
      near "$name, step $1 increment $2: force" "$(frame "$name" shear_resultant "$1" "$2")" "$3" "$tolerance"
      near "$name, step $1 increment $2: dissipation" "$(frame "$name" dissipation "$1" "$2")" "$(value "10*($4)")" "$tolerance"
   done
}
block() { # TYPE
   printf '%s' "*BLOCK, TYPE=$1, ELSET=B, NX=4, NY=2\\n0., 0.\\n<2*c>, <2*s>\\n<2*c-s>, <2*s+c>\\n<-s>, <c>"
}
# the same with coordinates of some digits
rounded() { # ANGLE DIGITS
   awk -v t="$1" -v d="$2" 'BEGIN { a = t*atan2(1, 1)/45; c = cos(a); s = sin(a); printf "*NODE"
      for (j = 0; j <= 2; j++) for (i = 0; i <= 4; i++) printf "\\n%d, %." d "f, %." d "f", 5*j + i + 1, c*i/2 - s*j/2, s*i/2 + c*j/2
      printf "\\n*ELEMENT, TYPE=CPE4, ELSET=B"
      for (j = 0; j < 2; j++) for (i = 1; i <= 4; i++) printf "\\n%d, %d, %d, %d, %d", 4*j + i, 5*j + i, 5*j + i + 1, 5*j + i + 6, 5*j + i + 5
      printf "\\n*NSET, NSET=B-BOTTOM\\n1, 2, 3, 4, 5\\n*SURFACE, NAME=B-BOTTOM\\n1, S1\\n2, S1\\n3, S1\\n4, S1\\n*SURFACE, NAME=B-TOP\\n5, S3\\n6, S3\\n7, S3\\n8, S3" }'
}
support='*TRANSFORM, NSET=B-BOTTOM\n<c>, <s>, 0., <-s>, <c>, 0.\n*BOUNDARY\nB-BOTTOM, 1'
equation='*EQUATION\n2\nB-BOTTOM, 1, <c>, B-BOTTOM, 2, <s>'
grip='*EQUATION\n4\nB-BOTTOM, 1, <c>, B-BOTTOM, 2, <s>, 2000, 1, <-c>, 2000, 2, <-s>'
for angle in 0. 30. 57.3; do
   tolerance=1e-9
   for form in dense sparse; do
      set -- --set "angle=$angle" --contact $form
      hold_side "support-$angle-$form" "$(block CPE4)" "$exact" "$support" 1000 1. 0 "$@"
      hold_side "equation-$angle-$form" "$(block CPE8)" "$exact" "$equation" 1000 1. 0 "$@"
      hold_side "grip-$angle-$form" "$(block CPE4)" "$exact" "$grip" 2000 -1. 0 "$@"
   done
   hold_side "support-slope-$angle" "$(block CPE8)" "$slope" "$support" 1000 1. 0.0025 --set "angle=$angle"
   for decimals in 4 6 9; do
      tolerance=$(value "100*10^(-$decimals)")
      hold_side "support-$angle-$decimals-decimals" "$(rounded $angle $decimals)" "$exact" "$support" 1000 1. 0 --set "angle=$angle"
   done
done

# The law of the total slip goes back as it came: no work in a closed loop.
deck "$(cat "$here/carried.inp")" 'FRICTION=*FRICTION, SLIP=TOTAL\n0.5' "OTHER=$floor" 'PAIR=B-BOTTOM, FLOOR' >total.inp
run 0 total.inp total --digits 17 --quiet
near 'total slip, there' "$(frame total shear_resultant 2 4)" -10 1e-9
near 'total slip, on the way back' "$(frame total shear_resultant 3 2)" -10 1e-9
near 'total slip, beyond' "$(frame total shear_resultant 3 5)" 10 1e-9
near 'total slip: work there' "$(frame total dissipation 2 4)" 1 1e-9
near 'total slip: work back to the middle' "$(value "$(frame total dissipation 3 2) - $(frame total dissipation 2 4)")" -0.8 1e-9
# A block that a reference node moves: what its rows bear leaves nothing of the contact forces, and both forms say the same. The way there and
# the way back end in nu N on either side.
for type in CPE4 CPE8; do
   for nodes in HIGH HIGH-BOTTOM; do
      for angle in 0 30; do
         for pair in 'HIGH-BOTTOM, LOW-TOP' 'LOW-TOP, HIGH-BOTTOM'; do
            name=seized-$type-$nodes-$angle-${pair%%-*}
            deck "$(cat "$here/seized.inp")" "TYPE=$type" "NODES=$nodes" "ANGLE=$angle" "PAIR=$pair" >"$name.inp"
            for form in dense sparse; do run 0 "$name.inp" "$name-$form" --digits 17 --quiet --contact $form; done
            same_tables "$name, both forms" "$name-dense/contact.tab" "$name-sparse/contact.tab" 1e-8
            for step in 2 3; do
               near "$name, step $step: nu N" "$(value "sqrt(($(frame "$name-sparse" shear_resultant $step 1))^2)")" \
                  "$(value "0.3*$(frame "$name-sparse" normal_resultant $step 1)")" 1e-6
            done
         done
      done
   done
done
finish
