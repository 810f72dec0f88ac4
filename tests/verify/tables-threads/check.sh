#!/bin/sh
# Tables of a mesh large enough that threads share out their rows: the same to the last bit with 1 to 4 threads, and a disk that is
# full while they work is told by exit 5, with nothing left behind.
. "$(dirname "$0")/../lib.sh"

sh "$here/../../bench/scene-p.sh" 90 >large.inp
run 0 large.inp one --threads 1 --quiet
[ "$(grep -vc '^#' one/stress.tab)" -eq 81000 ] || complain 'the stresses have not 81000 rows'
for threads in 2 3 4; do
   run 0 large.inp several --threads $threads --quiet
   for table in nodes stress reactions contact summary iterations; do
      cmp "one/$table.tab" "several/$table.tab" || complain "$table.tab with $threads threads"
   done
done

# 8000 blocks are 4 MB in dash and 8 in bash: less than the stresses, more than what comes before them
rm -rf full
(ulimit -f 8000; "$atrito" large.inp -o full --threads 4 --quiet) >full.out 2>&1
code=$?
[ "$code" -eq 5 ] || complain "a full disk: exit $code, expected 5"
says 'a full disk' full.out 'cannot be written completely'
absent full
finish
