#!/bin/sh
# A history that is killed in any increment and restarted: the tables are those of the unbroken run, to the last digit. Files of
# another deck, and damaged ones, are refused with their reason.
#    restart.sh ATRITO PRINT_DATASET REMOVE_DATASET
. "$(dirname "$0")/lib.sh"
atrito=$1
print_dataset=$2
remove_dataset=$3
cd "$work" || exit 9

# block LAST-VALUE MODULUS: a block on another one, pressed, pushed, and pushed back with other supports
block() {
   cat <<DECK
*BLOCK, TYPE=CPE4, ELSET=LOW, NX=24, NY=8
-0.5, -1
1.5, -1
1.5, 0
-0.5, 0
*BLOCK, TYPE=CPE4, ELSET=HIGH, NX=16, NY=8
0, 0
1, 0
1, 0.5
0, 0.5
*MATERIAL, NAME=STEEL
*ELASTIC
$2, 0.3
*SOLID SECTION, ELSET=LOW, MATERIAL=STEEL
*SOLID SECTION, ELSET=HIGH, MATERIAL=STEEL
*SURFACE INTERACTION, NAME=JOINT
*FRICTION
0.4
*CONTACT PAIR, INTERACTION=JOINT
HIGH-BOTTOM, LOW-TOP
*BOUNDARY
LOW-BOTTOM, 1, 2
*RESTART, WRITE
*STEP
*STATIC
*BOUNDARY
HIGH-TOP, 2, 2, -0.002
HIGH-LEFT, 1, 1, 0
*CONTACT PRINT, FREQUENCY=1
*NODE PRINT
U
*END STEP
*STEP
*STATIC
0.125, 1.
*BOUNDARY
HIGH-LEFT, 1, 1, 0.0012
*END STEP
*STEP
*STATIC
0.25, 1.
*BOUNDARY, OP=NEW
LOW-BOTTOM, 1, 2
HIGH-TOP, 2, 2, -0.002
HIGH-RIGHT, 1, 1, $1
*END STEP
DECK
}

# all LAW CONTROLS STEPS: the same with everything that is written, in different increments: temperatures of the second step alone,
# curves, ties, springs, two pairs, cut increments
all() {
   cat <<DECK
*AMPLITUDE, NAME=WAVE
0., 0., 0.3, 1., 0.6, -0.5, 1., 1.
*AMPLITUDE, NAME=TOTAL, TIME=TOTAL TIME, DEFINITION=SMOOTH STEP
0., 0., 1.5, 1., 3., 0.2
*BLOCK, TYPE=CPE4, ELSET=LOW, NX=12, NY=4
-0.5, -1
1.5, -1
1.5, 0
-0.5, 0
*BLOCK, TYPE=CPE4, ELSET=HIGH, NX=9, NY=4
0, 0
1, 0
1, 0.5
0, 0.5
*BLOCK, TYPE=CPE8, ELSET=CAP, NX=5, NY=2
0, 0.5
1, 0.5
1, 0.7
0, 0.7
*BLOCK, TYPE=CPE4, ELSET=LID, NX=7, NY=2
0, 0.7
1, 0.7
1, 0.8
0, 0.8
*ELEMENT, TYPE=SPRING1, ELSET=BED
9001, 5
*SPRING, ELSET=BED
2
250.
*MATERIAL, NAME=STEEL
*ELASTIC
1000, 0.3
*EXPANSION
1e-5
*SOLID SECTION, ELSET=LOW, MATERIAL=STEEL
*SOLID SECTION, ELSET=HIGH, MATERIAL=STEEL
*SOLID SECTION, ELSET=CAP, MATERIAL=STEEL
*SOLID SECTION, ELSET=LID, MATERIAL=STEEL
*SURFACE INTERACTION, NAME=JOINT
*FRICTION$1
*SURFACE INTERACTION, NAME=SOFT
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR
1e5
*FRICTION
0.3, 2e4
*CONTACT PAIR, INTERACTION=JOINT
HIGH-BOTTOM, LOW-TOP
*CONTACT PAIR, INTERACTION=SOFT
CAP-BOTTOM, HIGH-TOP
*TIE, NAME=GLUE
LID-BOTTOM, CAP-TOP
*BOUNDARY
LOW-BOTTOM, 1, 2
*RESTART, WRITE
*STEP
*STATIC
*BOUNDARY
LID-TOP, 2, 2, -0.002
HIGH-LEFT, 1, 1, 0
LID-LEFT, 1, 1, 0
*CONTACT PRINT, FREQUENCY=2
*NODE PRINT, FREQUENCY=3
U, RF
*EL PRINT, ELSET=HIGH, FREQUENCY=4
S
*BODY PRINT, FREQUENCY=2
*JOINT PRINT, FREQUENCY=1
*NODE FILE, FREQUENCY=2
U, RF
*EL FILE, FREQUENCY=2
S
*CONTACT FILE, FREQUENCY=2
*END STEP
*STEP
*STATIC
0.25, 1., 0.03, 0.4
*BOUNDARY
HIGH-LEFT, 1, 1, 0.0012
*DSLOAD, AMPLITUDE=WAVE
HIGH-RIGHT, P, 1.
*TEMPERATURE
HIGH, 30.
$2
*END STEP
DECK
   [ "$3" -gt 2 ] && cat <<DECK
*STEP
*STATIC
0.3, 1.
*BOUNDARY, OP=NEW
LOW-BOTTOM, 1, 2
LID-TOP, 2, 2, -0.002
LID-LEFT, 1, 1, 0
HIGH-RIGHT, 1, 1, -0.0005
*DSLOAD, AMPLITUDE=TOTAL
LID-TOP, P, 0.5
*TEMPERATURE, OP=NEW
LOW, 20.
*EL PRINT, ELSET=LOW
S
*END STEP
DECK
   return 0
}

# kill_behind K ARGUMENTS...: a run that is killed when the file of increment K is there: the progress, a line an increment, tells it
kill_behind() {
   k=$1
   shift
   rm -rf killed
   "$atrito" "$@" -o killed >progress 2>&1 &
   process=$!
   while kill -0 $process 2>/dev/null; do
      [ "$(grep -c '^step ' progress)" -lt "$k" ] || break
   done
   kill -9 $process 2>/dev/null
   wait $process 2>/dev/null
   [ -f killed/summary.tab ] || interrupted=$((interrupted + 1))
}

# expect CODE TEXT ARGUMENTS...: the exit code, and a text on standard error
expect() {
   expected=$1
   text=$2
   shift 2
   "$atrito" "$@" --quiet >said 2>&1
   code=$?
   [ "$code" -eq "$expected" ] || fail "$*: exit $code, expected $expected"
   [ -z "$text" ] || grep -qF -- "$text" said || { fail "$*: nothing of: $text"; cat said; }
}

# without_times: a listing without its times, bytes and factorisations, which are of the run, and the folder of a deck
without_times() {
   sed -e '/^atrito /d; /memory/d; /MiB/d; /factorisations/d' -e 's#plain/##; /^9  /,${/  [0-9]*\.[0-9]\{4\} /d;}' "$1"
}

# of_the_run: a file without the lines that are of another deck's text, where there is another
others=
of_the_run() {
   sed "$others" "$1"
}

# same A B: all tables but the times, the fields and the listing but its times are equal byte by byte
same() {
   for file in "$1"/*; do
      name=$(basename "$file")
      case $name in
      timing.tab | *.restart.h5) ;;
      *.lst)
         # lines of messages are broken by the length of the deck's path
         without_times "$file" | sed "$others" | tr -s ' \n' ' ' | fold -s >unbroken
         without_times "$2/$name" | sed "$others" | tr -s ' \n' ' ' | fold -s | diff unbroken - >different || { fail "$2/$name differs from the unbroken run's"; cat different; }
         ;;
      *)
         of_the_run "$file" >unbroken
         of_the_run "$2/$name" | cmp -s unbroken - || fail "$2/$name differs from the unbroken run's"
         ;;
      esac
   done
}

block -0.001 1000 >block.inp
interrupted=0
mkdir shorter
for form in dense sparse; do
   "$atrito" block.inp --quiet --digits 17 --contact $form -o whole || fail "the unbroken run: exit $?"
   [ -f whole/block.restart.h5 ] || fail 'there is no restart file'
   for k in 1 2 7 9 10 12; do
      kill_behind $k block.inp --digits 17 --contact $form
      [ -f killed/block.restart.h5 ] || continue
      "$atrito" block.inp --quiet --digits 17 --contact $form -o killed --restart killed/block.restart.h5 ||
         fail "restart behind increment $k, $form: exit $?"
      same whole killed
   done
done

# all that can be written, with laws, cut increments and forms of their own; one that ends early ends so again, with its code
all '
0.4' '' 3 >local.inp
all ', NONLOCAL
0.4, 1e-4, 0.15' '*CONTROLS, METHOD=PICARD, MAXIT=7' 3 >cut.inp
all ', NONLOCAL, SLIP=INCREMENTAL
0.4, 1e-4, 0.15' '' 3 >memory.inp
for run in local:dense:1 local:sparse:2 memory:auto:2 memory:sparse:1 cut:dense:1; do
   deck=${run%%:*}
   form=${run#*:}
   form=${form%:*}
   rm -rf whole
   set -- "$deck.inp" --digits 17 --progress all --contact "$form" --threads "${run##*:}"
   "$atrito" "$@" -o whole >progress 2>&1
   code=$?
   [ -f "whole/$deck.h5" ] || { fail "$run: exit $code"; tail -n 3 progress; }
   [ "$deck" != cut ] || grep -q 'has no solution; cut' progress || fail "$run: no increment is cut"
   for k in 1 3 6; do
      kill_behind $k "$@"
      [ -f "killed/$deck.restart.h5" ] || continue
      "$atrito" "$@" --quiet -o killed --restart "killed/$deck.restart.h5" >said 2>&1
      again=$?
      [ "$again" -eq "$code" ] || { fail "$run: restart behind increment $k: exit $again, not $code"; tail -n 3 said; }
      same whole killed
   done
done

# more steps behind the end of a history
all '
0.4' '' 2 >shorter/local.inp
rm -rf whole
"$atrito" local.inp --quiet --digits 17 -o whole || fail "the longer deck: exit $?"
"$atrito" shorter/local.inp --quiet --digits 17 -o killed || fail "the shorter deck: exit $?"
expect 0 '' local.inp --digits 17 -o killed --restart killed/local.restart.h5
same whole killed

[ "$interrupted" -ge 10 ] || fail "only $interrupted runs were killed before their end"

# from the end of the history nothing is left to do but to write; the deck need not ask for files any more
rm -rf whole
"$atrito" block.inp --quiet --digits 17 --contact sparse -o whole || fail "the unbroken run: exit $?"
cp whole/block.restart.h5 end.h5
mkdir plain
sed '/^\*RESTART/d' block.inp >plain/block.inp
others='/^# digest: /d; /digest [0-9a-f]*$/d; /^\*RESTART/d'      # the deck is another text
for deck in block.inp plain/block.inp; do
   expect 0 '' $deck --digits 17 --contact sparse -o killed --restart end.h5
   same whole killed
done
others=

# another deck, another version of it, other options
block -0.001 1001 >other.inp
expect 2 'sections and materials: not the same' other.inp --contact sparse --restart end.h5 -o none
expect 2 'options' block.inp --contact dense --restart end.h5 -o none
expect 2 'mesh: 378 nodes' block.inp --contact sparse --refine 1 --restart end.h5 -o none
block -0.0005 1000 >later.inp
expect 2 'prescribed displacements of step 3: not the same' later.inp --contact sparse --restart end.h5 -o none

# damaged files
head -c 5000 end.h5 >cut.h5
expect 5 'cut.h5: is damaged' block.inp --contact sparse --restart cut.h5 -o none
: >empty.h5
expect 5 'empty.h5: is no HDF5 file' block.inp --contact sparse --restart empty.h5 -o none
expect 5 'block.inp: is no HDF5 file' block.inp --contact sparse --restart block.inp -o none
expect 5 'there is no such file' block.inp --contact sparse --restart no.h5 -o none
cp -r whole folder.h5
expect 5 'folder.h5: is a folder' block.inp --contact sparse --restart folder.h5 -o none
"$print_dataset" end.h5 >lists || fail "$(cat lists)"
[ "$(grep -c . lists)" -ge 9 ] || fail "too few lists: $(cat lists)"
while read -r list; do
   cp end.h5 less.h5
   "$remove_dataset" less.h5 "$list" || fail "cannot take $list out of a file"
   expect 5 "less.h5: is damaged: $list is missing" block.inp --contact sparse --restart less.h5 -o none
done <lists
[ ! -e none ] || fail 'a run that was refused made its folder'

# a run that is refused leaves what is there, and so does the end of one that cannot write
cp -r whole kept
expect 2 'sections and materials: not the same' other.inp --contact sparse --restart end.h5 -o kept
expect 5 'is damaged' block.inp --contact sparse --restart cut.h5 -o kept
same whole kept
cmp -s end.h5 kept/block.restart.h5 || fail 'a run that was refused changed the restart file'

# no room for a file, and later no room for a larger one: one warning, and the history goes on; what was written whole stays
size=$(wc -c <end.h5)
for blocks in 1 $((size/512 - 16)); do
   rm -rf full
   (ulimit -f "$blocks"; exec "$atrito" block.inp --contact sparse --progress all -o full) 2>&1 | cat >said
   [ "$(grep -c '\[W-RESTART\]' said)" -eq 1 ] || { fail "$blocks blocks: not one warning"; grep -v '^ ' said; }
   [ "$(grep -c '^step ' said)" -eq 13 ] || fail "$blocks blocks: the history does not go on"
   [ -z "$(ls full/*.part 2>/dev/null)" ] || fail "$blocks blocks: a temporary file is left"
   [ "$blocks" -gt 1 ] || continue
   rm -rf later
   expect 0 '' block.inp --digits 17 --contact sparse -o later --restart full/block.restart.h5
   same whole later
done

# a long history of large prints does not write all of them again and again, and goes on from what it wrote
sed -e '/^\*STEP/,$d' block.inp >long.inp
cat >>long.inp <<'DECK'
*STEP, INC=1000
*STATIC
0.004, 1., 1e-5, 0.004
*BOUNDARY
HIGH-TOP, 2, 2, -0.002
HIGH-LEFT, 1, 1, 0
*CONTACT PRINT, FREQUENCY=1
*NODE PRINT, FREQUENCY=1
U
*EL PRINT, FREQUENCY=1
S
*END STEP
DECK
if command -v strace >/dev/null 2>&1 && strace -o calls -e trace=rename true 2>/dev/null; then
   strace -f -o calls -e trace=rename,renameat,renameat2 "$atrito" long.inp --quiet -o long || fail 'the long history does not end'
   increments=$(grep -vc '^#' long/history.tab)
   files=$(grep -c 'long.restart.h5"' calls)
   [ "$increments" -eq 250 ] || fail "the long history has $increments increments"
   [ "$files" -ge 2 ] && [ "$files" -le 125 ] || fail "a history of 250 increments wrote $files restart files"
   expect 0 '' long.inp --quiet --restart long/long.restart.h5 -o again
   same long again
else
   echo 'not tested: how often a restart file is written (no strace)'
fi

# only a run goes on
expect 1 '--restart is no option of atrito sweep' sweep block.inp --vary a=1 --restart end.h5
expect 1 '--restart is no option of atrito check' check block.inp --restart end.h5
[ -z "$(ls killed/*.part 2>/dev/null)" ] || fail 'a temporary file is left'
finish
