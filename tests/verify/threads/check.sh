# The tables of a run are the same to the last digit for any number of threads. The scenes have more elements than those from which
# on work is shared out (atrito_threads), 4096: example 1 has elements of four nodes on a rigid motion, example 3 of nine nodes in
# layers of two materials, with prescribed displacements, scene P of the benchmark a body for the sparse solver. The tapered block has
# no two elements that are alike.
. "$(dirname "$0")/../lib.sh"

# same_for_all NAME DECK [options]
same_for_all() {
   name=$1
   deck=$2
   shift 2
   for n in 1 2 3 4; do
      run 0 "$deck" "$name-$n" "$@" --digits 17 --threads "$n" --quiet
      grep -h 'estimated error' "$name-$n"/*.lst >"$name-$n/estimate"
      grep -q '%' "$name-$n/estimate" || complain "$name: no estimate in the listing"
      [ "$n" -eq 1 ] && continue
      for table in "$name-1"/*.tab "$name-1/estimate"; do
         case $table in */timing.tab) continue ;; esac
         cmp "$table" "$name-$n/${table##*/}" || complain "$name: ${table##*/} with $n threads"
      done
   done
   for table in nodes stress contact summary reactions; do
      [ -s "$name-1/$table.tab" ] || complain "$name: no $table.tab"
   done
}

# deck_has AT_LEAST FOLDER: elements of the scene, by the rows of its stresses.
deck_has() {
   found=$(awk '!/^#/ && $2 != last { n++; last = $2 } END { print n + 0 }' "$2/stress.tab")
   [ "$found" -ge "$1" ] || complain "$2: $found elements are too few"
}

same_for_all four-nodes "$input/ex1-plate-on-support.inp" --refine 3
deck_has 4096 four-nodes-1
same_for_all nine-nodes "$input/ex3-pillar-in-ground.inp" --refine 4
deck_has 4096 nine-nodes-1
sh "$here/../../bench/scene-p.sh" 100 >fronts.inp
same_for_all fronts fronts.inp
deck_has 25000 fronts-1
says 'listing of the fronts' fronts-1/fronts.lst 'LOWER: sparse'
same_for_all tapered "$here/tapered.inp" --solver sparse
deck_has 4096 tapered-1
finish
