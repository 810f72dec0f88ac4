#!/bin/sh
# The order of elimination: told, of no influence on the results.
#    check.sh ATRITO FOLDER INPUT METIS      METIS: 1 where the program has it
. "$(dirname "$0")/../lib.sh"
metis=$4

# same_by_skyline NAME ORDER: a run by the sparse solver tells its order, as `check` does, and has the tables of the skyline.
same_by_skyline() {
   run 0 "$1.inp" "$1" --digits 17 --quiet
   "$atrito" check "$1.inp" >"$1.check" || complain "$1: check failed"
   says "$1, listing" "$1/$1.lst" "ALL: order of elimination $2"
   says "$1, check" "$1.check" "ALL: order of elimination $2"
   run 0 "$1.inp" "$1-skyline" --solver skyline --digits 17 --quiet
   grep -q 'order of elimination' "$1-skyline/$1.lst" && complain "$1: an order of elimination by the skyline"
   same_tables "$1" "$1/nodes.tab" "$1-skyline/nodes.tab" 1e-9
}

sh "$here/ring.sh" 3000 >ring.inp
if [ "$metis" = 1 ]; then
   same_by_skyline ring 'by METIS, predicted operations 0.'
   grep -q 'METIS [.]* [0-9]' ring/ring.lst || complain 'the version of METIS is not in the listing'
else
   same_by_skyline ring 'by places'
fi

sh "$here/askew.sh" >askew.inp
same_by_skyline askew 'by places, turned by 30 degrees'
finish
