#!/bin/sh
# What goes wrong with several ranks: one message, the exit code of the plain program, no half file, nobody waits for ever.
#    failures.sh ATRITO-MPI ATRITO DECK DECK-WITHOUT-SOLUTION FAULTY-END
. "$(dirname "$0")/lib.sh"
atrito=$2
deck=$3
loose=$4
faulty_end=$5

# --- errors of deck and command line: what the plain program says ------------------------------------------------------------------
printf '*NODE\nx\n' >bad.inp
for words in 'bad.inp' 'nowhere.inp' "$deck --nonsense" "$deck --set nonsense=1" '--nonsense' "check bad.inp" "$deck --messages json --set q=a"; do
   "$atrito" $words >out.plain 2>err.plain
   expected=$?
   [ "$expected" -ne 0 ] || fail "$words: not an error"
   for n in 1 2 4; do
      by_ranks $n $words
      expect_code $expected "$words, $n ranks"
      cmp -s err err.plain || { fail "$words, $n ranks: says something else"; diff err.plain err; }
      all_gone "$words, $n ranks"
   done
done

# --- a mesh of more nodes than one process may have: what there is of memory decides, up to what numbers of 32 bits count ------------
block() { # block N: N x N elements
   printf '%s\n' "*BLOCK, TYPE=CPE4, ELSET=B, NX=$1, NY=$1" '0, 0' '1, 0' '1, 1' '0, 1' '*MATERIAL, NAME=M' '*ELASTIC' '1, 0.3' \
      '*SOLID SECTION, ELSET=B, MATERIAL=M' '*BOUNDARY' 'B-BOTTOM, 1, 2' '*STEP' '*STATIC' '*END STEP' >block.inp
}
block 8000
"$atrito" check block.inp >out.plain 2>err.plain
told err.plain 'a block of more than 50000000 nodes' || fail 'a block of 64 million nodes in one process: not refused'
mpirun -n 1 sh -c 'ulimit -v 8000000; exec "$0" "$@"' "$atrito_mpi" check block.inp >out 2>err
code=$?
expect_code 2 'a block of 64 million nodes in 8 GB'
said_once 'a block of 64 million nodes in 8 GB' 'E-MEMORY.*a mesh of 64016001 nodes'
block 25000
by_ranks 1 check block.inp
expect_code 2 'a block of 625 million nodes'
said_once 'a block of 625 million nodes' 'a block of more than 500000000 nodes'

# --- a scene without a solution ------------------------------------------------------------------------------------------------------
"$atrito" "$loose" --set side=0.1 -o loose >out.plain 2>err.plain
expected=$?                                              # 4, or 3 of a build without Clp
[ $expected -eq 4 ] || [ $expected -eq 3 ] || fail "the scene without a solution: exit $expected"
for n in 1 2; do
   rm -rf loose
   by_ranks $n "$loose" --set side=0.1 -o loose
   expect_code $expected "a scene without a solution, $n ranks"
   cmp -s err err.plain || { fail "a scene without a solution, $n ranks: says something else"; diff err.plain err; }
done

# --- the end of MPI itself goes wrong: nobody need know -----------------------------------------------------------------------------------
for words in "$deck --digits 17" bad.inp; do
   "$atrito" $words -o plain >out.plain 2>err.plain
   expected=$?
   mpirun -n 2 -x LD_PRELOAD="$faulty_end" "$atrito_mpi" $words -o ended >out 2>err
   code=$?
   expect_code $expected "a fault in MPI_Finalize, $words"
   [ "$(grep -c . out)" -eq "$(grep -c . out.plain)" ] || fail 'a fault in MPI_Finalize: the summary is not complete'
   grep -q 'E-INTERNAL\|Backtrace' err && { fail 'a fault in MPI_Finalize: told'; cat err; }
done
"$atrito" compare plain ended --rtol 1e-10 --quiet || fail 'a fault in MPI_Finalize: other tables'

# --- a full disk on rank 0 (a limit on the size of files comes as one does); the network of one machine needs files ---------------------
"$atrito" "$deck" -o old --quiet || fail 'the deck itself fails'
cp -r old kept
full_disk() { # full_disk FOLDER
   OMPI_MCA_btl=self,tcp mpirun -n 1 sh -c 'ulimit -f 1; exec "$0" "$@"' "$atrito_mpi" "$deck" --digits 17 --quiet -o "$1" : \
      -n 1 "$atrito_mpi" "$deck" --digits 17 --quiet -o "$1" >out 2>err
   code=$?
}
for folder in old new/er; do
   full_disk $folder
   expect_code 5 "a full disk on rank 0, $folder"
   told err "$folder/" || { fail 'a full disk on rank 0: no file is named'; cat err; }
   nothing_left $folder 'a full disk on rank 0'
done
same_files kept old 'a full disk on rank 0'
[ ! -e new ] || fail 'a full disk on rank 0: the new folder is left'

# --- too little memory ------------------------------------------------------------------------------------------------------------------
# short_of_memory RANK KBYTES WORDS: two ranks, one of which may have so much address space.
short_of_memory() {
   rank=$1
   room=$2
   shift 2
   mpirun -n 2 sh -c '[ "$OMPI_COMM_WORLD_RANK" != "$1" ] || ulimit -v "$2"; shift 2; exec "$0" "$@"' "$atrito_mpi" "$rank" "$room" "$@" >out 2>err
   code=$?
}
short_of_memory 0 1500000 "$deck" --refine 7 -o short
expect_code 2 'too little memory on rank 0'
said_once 'too little memory on rank 0' E-MEMORY
[ ! -e short ] || fail 'too little memory on rank 0: a folder was made'
short_of_memory 1 500000 "$deck" --refine 6 -o short
expect_code 2 'too little memory on rank 1'
said_once 'too little memory on rank 1' 'E-MEMORY. rank 1 of 2 needs'
told err 'expected: more ranks, a coarser mesh' || { fail 'too little memory on rank 1: not what would help'; cat err; }
[ ! -e short ] || fail 'too little memory on rank 1: a folder was made'
short_of_memory 0 500000 "$deck" --refine 6 -o short
expect_code 2 'too little memory for the mesh on rank 0'
said_once 'too little memory for the mesh on rank 0' E-MEMORY

# so much address space for each rank that one alone does not have enough, and two have: 25 MiB less than what it says it needs
limited() { # limited KBYTES RANKS WORDS
   room=$1
   n=$2
   shift 2
   mpirun -n "$n" sh -c 'ulimit -v "$1"; shift; exec "$0" "$@"' "$atrito_mpi" "$room" "$@" >out 2>err
   code=$?
}
# a wedge, no two of whose elements are equal: factors take the most
printf '%s\n' '*BLOCK, TYPE=CPE4, ELSET=B, NX=400, NY=400' '0, 0' '4, 0' '3, 2' '0, 2' '*MATERIAL, NAME=M' '*ELASTIC' '1, 0.3' \
   '*SOLID SECTION, ELSET=B, MATERIAL=M' '*BOUNDARY' 'B-BOTTOM, 1, 2' '*STEP' '*STATIC' '*DSLOAD' 'B-TOP, P, 1e-3' '*END STEP' >wedge.inp
set -- wedge.inp --quiet
limited 700000 1 "$@" -o alone
room=$(sed -n 's/.* needs about \([0-9.]*\) MiB of memory, there are \([0-9.]*\) MiB.*/\1 \2/p' err |
   awk '{ printf "%.0f", 700000 + 1024*($1 - $2 - 25) }')
case $room in
'') fail 'memory that two ranks have together: the amounts are not told' ;;
*)
   limited "$room" 1 "$@" -o alone
   expect_code 2 'too much for one rank'
   limited "$room" 2 "$@" -o together
   expect_code 0 'not too much for two ranks'
   "$atrito" "$@" --contact sparse -o plain
   # 300,000 displacements have round-off of 1e-9
   "$atrito" compare plain together --rtol 1e-8 --quiet || { fail 'not too much for two ranks: other tables'; cat err; }
   ;;
esac

# --- killed ranks -------------------------------------------------------------------------------------------------------------------------
# mpirun lets the other ranks go on for a second: the mesh takes longer.
# kill_rank RANK SIGNAL: while the deck is solved.
kill_rank() {
   begin 3 "$deck" --refine 6 --progress all -o old
   await told err '^read '
   kill -"$2" "$(cat "pid.$1")" 2>/dev/null
   end
}
for rank in 0 1 2; do
   kill_rank $rank KILL
   expect_code 137 "SIGKILL of rank $rank"
   all_gone "SIGKILL of rank $rank"
   [ $rank -eq 0 ] || said_once "SIGKILL of rank $rank" E-INTERRUPTED
   nothing_left old "SIGKILL of rank $rank"
done
for rank in 0 1; do
   kill_rank $rank TERM
   expect_code 143 "SIGTERM of rank $rank"
   said_once "SIGTERM of rank $rank" E-INTERRUPTED
   all_gone "SIGTERM of rank $rank"
done
same_files kept old 'killed ranks'
kill_rank 1 SEGV
expect_code 139 'SIGSEGV of rank 1'
said_once 'SIGSEGV of rank 1' E-INTERRUPTED
all_gone 'SIGSEGV of rank 1'

# --- mpirun is told to end --------------------------------------------------------------------------------------------------------------
begin 3 "$deck" --refine 6 --progress all -o old
await told err '^read '
kill -TERM $run
end
expect_code 1 'SIGTERM of mpirun'                        # its own code; ./run --ranks makes 143 of it
said_once 'SIGTERM of mpirun' E-INTERRUPTED
all_gone 'SIGTERM of mpirun'
same_files kept old 'SIGTERM of mpirun'

# --- while tables are written ---------------------------------------------------------------------------------------------------------------
strip() { # strip N: a strip of N elements, cheap to solve
   printf '%s\n' "*BLOCK, TYPE=CPE4, ELSET=B, NX=2, NY=$1" '0, 0' '2, 0' "2, $1" "0, $1" '*MATERIAL, NAME=M' '*ELASTIC' '1, 0.3' \
      '*SOLID SECTION, ELSET=B, MATERIAL=M' '*BOUNDARY' 'B-LEFT, 1, 2' '*STEP' '*STATIC' '*DSLOAD' 'B-RIGHT, P, 1' '*NODE PRINT' \
      'U, RF' '*EL PRINT' 'S' '*END STEP' >strip.inp
}
# kill_writing RANK SIGNAL FOLDER: when a temporary file is seen
kill_writing() {
   for size in 20000 80000 320000; do
      strip $size
      rm -rf "$3"
      begin 2 strip.inp -o "$3" --quiet --digits 17
      await parts "$3"
      kill -"$2" "$(cat "pid.$1")" 2>/dev/null
      end
      [ "$code" -ne 0 ] && break
   done
}
kill_writing 0 KILL killed
expect_code 137 'SIGKILL of rank 0 while it writes'
parts killed || echo 'not tested: what SIGKILL leaves, all names were given'
strip 20
by_ranks 2 strip.inp -o killed --quiet
expect_code 0 'the run after it'
nothing_left killed 'the run after it'
kill_writing 0 TERM some/where/new
expect_code 143 'SIGTERM of rank 0 while it writes'
[ ! -e some ] || fail 'SIGTERM of rank 0 while it writes: something is left'
# all files or none: rank 0 may have written all of them before mpirun comes to it
kill_writing 1 KILL some/where/new
expect_code 137 'SIGKILL of rank 1 while rank 0 writes'
nothing_left some 'SIGKILL of rank 1 while rank 0 writes'
[ ! -e some ] || [ -f some/where/new/stress.tab ] || fail 'SIGKILL of rank 1 while rank 0 writes: half of the files are left'

finish
