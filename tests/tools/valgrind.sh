#!/bin/sh
# No read of a value that nothing has set, no bytes beside an array, and nothing lost, by valgrind: example 1, decks with errors, one
# that has no solution, histories with fields and restart files in both forms of the contact system, tables, wrong command lines.
#    valgrind.sh ATRITO PROJECT
. "$(dirname "$0")/lib.sh"
atrito=$1
project=$2
here=$(cd "$(dirname "$0")" && pwd)
cd "$work" || exit 9

# clean CODE WHAT ARGUMENTS...
clean() {
   wanted=$1
   what=$2
   shift 2
   valgrind --quiet --error-exitcode=99 --leak-check=full --show-leak-kinds=definite,indirect,possible \
      --errors-for-leak-kinds=definite,indirect,possible --num-callers=30 --suppressions="$here/valgrind.supp" --log-file=log \
      "$atrito" "$@" >out 2>&1 </dev/null
   code=$?
   [ "$code" -eq "$wanted" ] && return
   fail "$what: exit $code, expected $wanted"
   head -n 60 log
   tail -n 5 out
}

# history FORM-OF-STATIC: two blocks with friction, all that is printed
history() {
   cat <<DECK
*BLOCK, ELSET=LOW, TYPE=CPE4, NX=3, NY=2
0, 0
1, 0
1, 1
0, 1
*BLOCK, ELSET=HIGH, TYPE=CPE8, NX=2, NY=2
0, 1
1, 1
1, 2
0, 2
*MATERIAL, NAME=M
*ELASTIC
1000, 0.3
*SOLID SECTION, ELSET=LOW, MATERIAL=M
1
*SOLID SECTION, ELSET=HIGH, MATERIAL=M
1
*SURFACE INTERACTION, NAME=I
*FRICTION, NONLOCAL
0.3, 1e-4, 0.4
*CONTACT PAIR, INTERACTION=I
HIGH-BOTTOM, LOW-TOP
*BOUNDARY
LOW-BOTTOM, 1, 2
*RESTART, WRITE
*STEP
*STATIC
0.5, 1.
*BOUNDARY
HIGH-TOP, 1, 2, -0.001
*NODE PRINT
U, RF
*EL PRINT, ELSET=HIGH
S
*CONTACT PRINT, FREQUENCY=1
*BODY PRINT
*JOINT PRINT
*NODE FILE
U, RF
*EL FILE
S
*END STEP
*STEP
*STATIC
0.5, 1.
*BOUNDARY
HIGH-TOP, 1, 1, 0.001
*END STEP
DECK
}

deck=$project/input/ex1-plate-on-support.inp
clean 0 'example 1' "$deck" -o ex1
clean 0 'example 1, sparse' "$deck" --quiet --contact sparse -o ex1s
clean 0 'example 1, other solvers and tables' "$deck" --quiet --solver sparse --format csv --observe 'tip=u2(12)' -o ex1c
clean 0 'check' check "$deck"
history >history.inp
for form in dense sparse; do
   clean 0 "a history, $form" history.inp --quiet --contact $form -o whole
   clean 0 "a history goes on, $form" history.inp --quiet --contact $form -o again --restart whole/history.restart.h5
done
clean 0 'tables' compare whole again
clean 0 'a report' "$deck" --quiet --report -o ex1r
clean 0 'a sweep' sweep "$deck" --vary q=1,2 --quiet -o sweep
clean 0 'a study' study "$deck" --levels 2 --quiet -o study
sed 's/1000, 0.3/1000, 0.7/; s/^HIGH-TOP/NO-SUCH/; s/FRICTION/FRICTON/' history.inp >errors.inp
clean 2 'a deck with errors' errors.inp
clean 2 'messages as JSON' errors.inp --messages json
sed '/^HIGH-TOP/s/-0.001/0.001/; s/HIGH-TOP, 1, 2/HIGH-TOP, 1, 1/; /^\*END STEP/i *DLOAD\nHIGH, BY, 1.' history.inp >free.inp
clean 4 'a body that flies away' free.inp -o free
clean 1 'a wrong command line' "$deck" --no-such-option
clean 5 'no file' none.inp
clean 5 'no restart file' history.inp --restart errors.inp

# and what is wrong is noticed
if [ "$failures" -eq 0 ]; then
   clean 3 'must fail' "$deck" --quiet -o ex1 >must
   [ "$failures" -eq 1 ] || fail 'a wrong exit code is not noticed'
   failures=$((failures - 1))
fi
finish
