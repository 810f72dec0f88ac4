#!/bin/sh
# --confine over ranks: what is outside is read by none of them, and told once, in the words of the plain program.
#    confine.sh ATRITO-MPI ATRITO
. "$(dirname "$0")/lib.sh"
atrito=$2

square() { # square FOLDER INCLUDE
   printf '%s\n' '*HEADING' 'a square' '*PARAMETER' 'q = 1' "*INCLUDE, INPUT=$2" '*ELEMENT, TYPE=CPE4, ELSET=B' '1, 1, 2, 3, 4' \
      '*MATERIAL, NAME=M' '*ELASTIC' '1000, 0.3' '*SOLID SECTION, ELSET=B, MATERIAL=M' '*BOUNDARY' '1, 1, 2' '2, 2' '*STEP' '*STATIC' \
      '*CLOAD' '3, 2, <q>' '*NODE PRINT' 'U, RF' '*END STEP' >"$1/a.inp"
}
not_shown() { # not_shown WHAT
   grep -rq SECRET out err results 2>/dev/null && fail "$1: what is outside is shown"
}

mkdir -p hand others
printf '*NODE\n1, 0, 0\n2, 1, 0\n3, 1, 1\n4, 0, 1\n' >hand/nodes.inc
printf '*NODE\n** SECRET\n1, 0, 0\n2, 1, 0\n3, 1, 1\n4, 0, 1\n' >others/sound.inc
printf '*NODE\nSECRET\n' >others/secret.inc
ln -s ../others/secret.inc hand/link.inc
for words in 'hand/a.inp' 'check hand/a.inp' 'sweep hand/a.inp --vary q=1,2,3,4' 'study hand/a.inp --levels 2'; do
   where='-o results'
   [ "${words%% *}" = check ] && where=
   for n in 2; do
      square hand nodes.inc
      rm -rf results
      by_ranks $n $words --confine hand $where --quiet
      expect_code 0 "$words inside, $n ranks"
      for include in ../others/secret.inc ../others/none.inc link.inc; do
         square hand $include
         rm -rf results
         "$atrito" $words --confine hand $where --quiet >out.plain 2>err.plain
         by_ranks $n $words --confine hand $where --quiet
         expect_code 5 "$words with $include, $n ranks"
         cmp -s err err.plain || { fail "$words with $include, $n ranks: says something else"; diff err.plain err; }
         not_shown "$words with $include, $n ranks"
         [ ! -e results ] || fail "$words with $include, $n ranks: a folder was made"
         all_gone "$words with $include, $n ranks"
      done
   done
done

# Each rank for itself: the second one has another folder of the same name before it, in which the included file leads outside. Its
# runs are refused, those of the first one are not.
mkdir -p rank.0/hand rank.1/hand
square rank.0/hand nodes.inc
square rank.1/hand nodes.inc
cp hand/nodes.inc rank.0/hand
ln -s ../../others/sound.inc rank.1/hand/nodes.inc
for confine in '' '--confine hand'; do
   rm -rf results
   mpirun -n 2 sh -c 'cd rank.$OMPI_COMM_WORLD_RANK; exec "$0" "$@"' "$atrito_mpi" sweep hand/a.inp --vary q=1,2,3,4,5,6,7,8 $confine \
      -o "$work/results" --quiet >out 2>err
   code=$?
   shown=$(grep -rl SECRET results | wc -l)
   if [ -z "$confine" ]; then
      [ "$shown" -gt 0 ] || fail 'the second rank has no runs: the test shows nothing'
   else
      [ "$shown" -eq 0 ] || fail 'the second rank reads what is outside'
      expect_code 5 'a sweep whose second rank finds a link to the outside'
      told err 'outside of the folder of --confine' || { fail 'the second rank: not told'; cat err; }
   fi
done
finish
