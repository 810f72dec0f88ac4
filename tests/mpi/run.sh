#!/bin/sh
# ./run --ranks N with the true mpirun and program: one message, the exit code of the run, tables; what --version and the listing say.
#    run.sh ATRITO-MPI ATRITO SOURCES
. "$(dirname "$0")/lib.sh"
atrito=$2
sources=$3

# the sources, with a build that is there
mkdir -p top/tools top/build/run-mpi bin
cp "$sources/run" "$sources/CMakePresets.json" top
cp "$sources/tools/setup.sh" "$sources/tools/ranks.sh" top/tools
for package in gnuplot-nox libmumps-seq-dev coinor-libclp-dev libmetis-dev; do : >"top/build/$package-tried"; done
ln -s "$(dirname "$atrito_mpi")" top/build/run-mpi/bin
echo "CMAKE_HOME_DIRECTORY:INTERNAL=$work/top" >top/build/run-mpi/CMakeCache.txt
: >top/build/run-mpi/Makefile
printf '%s\n' '#!/bin/sh' 'exit 0' >bin/cmake
chmod +x bin/cmake
PATH=$work/bin:$PATH
unset OMPI_ALLOW_RUN_AS_ROOT OMPI_ALLOW_RUN_AS_ROOT_CONFIRM OMPI_MCA_orte_execute_quiet OMPI_MCA_rmaps_base_oversubscribe OMPI_MCA_pml

deck=$sources/input/lessons/block.inp
printf '*NODE\nx\n' >bad.inp
"$atrito" bad.inp 2>err.plain
"$atrito" "$deck" -o plain --quiet || fail 'the deck itself fails'
many=$(($(nproc 2>/dev/null || echo 2) + 2))              # more than there are cores
for n in 1 2 $many; do
   top/run --ranks $n "$deck" -o "by-$n" --digits 17 >out 2>err
   code=$?
   expect_code 0 "$n ranks"
   "$atrito" compare plain "by-$n" --rtol 1e-8 --quiet || fail "$n ranks: other tables"
   top/run --ranks $n bad.inp >out 2>err
   code=$?
   expect_code 2 "an error in the deck, $n ranks"
   cmp -s err err.plain || { fail "an error in the deck, $n ranks: says something else"; cat err; }
   ranks='1 rank'
   [ "$n" -eq 1 ] || ranks="$n ranks"
   top/run --ranks $n --version >out 2>err || fail "--version: exit $?"
   grep -q "^MPI: .*[0-9], $ranks\$" out || { fail "$n ranks: --version does not say so"; cat out; }
done
"$atrito" --version | grep -q '^MPI' && fail 'the plain program has an MPI'
grep -q "^ *MPI [ .]*.*, $many ranks\$" "by-$many/block.lst" || fail 'the listing does not tell the ranks'
grep -q '^ *MPI ' by-1/block.lst && fail 'the listing of one rank tells of MPI'

# who goes over the ranks: a scene that is large, or all of them, in the sparse form; by the dense form the first rank alone
form_of() { # form_of FORM WHAT OPTIONS: two ranks
   form=$1
   what=$2
   shift 2
   top/run --ranks 2 "$@" -o form --quiet >out 2>err || { fail "$what: exit $?"; cat err; }
   grep -q "$form" form/*.lst || { fail "$what: not the form that was expected"; grep 'contact system' form/*.lst; }
   rm -rf form
}
plates=$sources/input/ex2-two-plates.inp
form_of 'sparse, the one that goes over ranks' 'a scene that is shared' "$plates" --share all
form_of 'sparse, the one that goes over ranks' 'a scene without contact that is shared' "$deck" --share all
form_of 'dense, predicted' 'a small scene' "$plates"
form_of 'dense, predicted' 'a scene that is not to be shared' "$plates" --share none
form_of 'dense, asked for' 'the dense form' "$plates" --share all --contact dense
form_of 'dense, predicted' 'another solver' "$plates" --share all --solver skyline
sed "s/^\*STATIC.*/&\n*CONTROLS, METHOD=PICARD/" "$plates" >picard.inp
form_of 'dense, the method that is asked for' 'a method of the dense form' picard.inp --share all

# ended from outside, seconds before it would write
sh -c 'echo $$ >id; exec "$@"' sh top/run --ranks 2 "$sources/input/ex1-plate-on-rigid-support.inp" --refine 6 --share all --progress all -o ended >out 2>err &
run=$!
await told err '^read '
kill -TERM "$(cat id)"
end
expect_code 143 'SIGTERM of ./run --ranks'
said_once 'SIGTERM of ./run --ranks' E-INTERRUPTED
[ ! -e ended ] || fail 'SIGTERM of ./run --ranks: something is left'
finish
