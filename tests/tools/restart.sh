#!/bin/sh
# A history that is killed in any increment and restarted: the tables are those of the unbroken run, to the last digit. Files of
# another deck, and damaged ones, are refused with their reason.
#    restart.sh ATRITO
. "$(dirname "$0")/lib.sh"
atrito=$1
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

# same A B: all tables but the times are equal byte by byte
same() {
   for table in "$1"/*.tab; do
      name=$(basename "$table")
      [ "$name" = timing.tab ] || cmp -s "$table" "$2/$name" || fail "$2/$name differs from the unbroken run's"
   done
}

block -0.001 1000 >block.inp
interrupted=0
for form in dense sparse; do
   "$atrito" block.inp --quiet --digits 17 --contact $form -o whole || fail "the unbroken run: exit $?"
   [ -f whole/block.restart.h5 ] || fail 'there is no restart file'
   for k in 1 2 3 5 7 9 10 11 12; do
      rm -rf killed
      # killed when the file of increment k is there: the progress, a line an increment, tells it
      "$atrito" block.inp --digits 17 --contact $form -o killed >progress 2>&1 &
      process=$!
      while kill -0 $process 2>/dev/null; do
         [ "$(grep -c '^step ' progress)" -lt "$k" ] || break
      done
      kill -9 $process 2>/dev/null
      wait $process 2>/dev/null
      [ -f killed/block.restart.h5 ] || continue
      [ -f killed/summary.tab ] || interrupted=$((interrupted + 1))
      "$atrito" block.inp --quiet --digits 17 --contact $form -o killed --restart killed/block.restart.h5 ||
         fail "restart behind increment $k, $form: exit $?"
      same whole killed
   done
done

[ "$interrupted" -ge 6 ] || fail "only $interrupted runs were killed before their end"

# from the end of the history nothing is left to do but to write
expect 0 '' block.inp --digits 17 --contact sparse -o killed --restart whole/block.restart.h5
same whole killed
cp whole/block.restart.h5 end.h5

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
[ ! -e none ] || fail 'a run that was refused made its folder'

# only a run goes on
expect 1 '--restart is no option of atrito sweep' sweep block.inp --vary a=1 --restart end.h5
expect 1 '--restart is no option of atrito check' check block.inp --restart end.h5
[ -z "$(ls killed/*.part 2>/dev/null)" ] || fail 'a temporary file is left'
finish
