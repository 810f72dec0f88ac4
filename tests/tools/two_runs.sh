#!/bin/sh
# Two runs into one folder at once: they write one after the other, and what is left is all from one of them.
#    two_runs.sh ATRITO DECK
. "$(dirname "$0")/lib.sh"
atrito=$1
deck=$2
cd "$work" || exit 9

same() { # same A B: all tables but the times, and the listing up to its times
   "$atrito" compare "$1" "$2" --rtol 0 >/dev/null || return 1
   cmp -s "$1/nodes.tab" "$2/nodes.tab" && cmp -s "$1/stress.tab" "$2/stress.tab" && cmp -s "$1/contact.tab" "$2/contact.tab"
}

# races: whichever was last, it is one of the two
"$atrito" "$deck" --refine 2 -o one --quiet --set nu=0.1 || fail 'the deck itself fails'
"$atrito" "$deck" --refine 2 -o two --quiet --set nu=0.4 || fail 'the deck itself fails'
same one two && fail 'the two cannot be told apart'
for i in 1 2 3 4 5 6 7 8 9 10; do
   [ $((i % 2)) -eq 0 ] || rm -rf both
   "$atrito" "$deck" --refine 2 -o both --quiet --set nu=0.1 2>err.1 &
   first=$!
   "$atrito" "$deck" --refine 2 -o both --quiet --set nu=0.4 2>err.2 &
   second=$!
   wait $first || { fail "race $i: the first ends with $?"; cat err.1; }
   wait $second || { fail "race $i: the second ends with $?"; cat err.2; }
   same both one || same both two || fail "race $i: a mixture"
   grep -v '^wait  another run writes into both$' err.1 err.2 && fail "race $i: something else was said"
   [ -z "$(find both -name '*.part')" ] || fail "race $i: a temporary file is left"
done

# one that fails and removes the folder that it made, and one that waits for it
for i in 1 2 3 4 5; do
   rm -rf both
   (ulimit -f 1; "$atrito" "$deck" --refine 2 -o both --quiet --digits 17 2>err.1) &
   first=$!
   "$atrito" "$deck" --refine 2 -o both --quiet --set nu=0.4 2>err.2 &
   second=$!
   wait $first
   [ $? -eq 5 ] || fail "failing race $i: not exit 5"
   wait $second || { fail "failing race $i: exit $?"; cat err.2; }
   same both two || fail "failing race $i: not the tables of the other"
done

# the claim itself, a lock on .atrito.lock: held by another program, the run waits for it and says so
if command -v flock >/dev/null; then
   flock both/.atrito.lock sh -c 'echo held >is-held; until [ -e go ]; do sleep 0.02 2>/dev/null || sleep 1; done' &
   holder=$!
   until [ -s is-held ]; do pause; done
   "$atrito" "$deck" --refine 2 -o both --quiet --set nu=0.1 2>err >out &
   run=$!
   until grep -q 'wait  another run writes into both' err || ! kill -0 $run 2>/dev/null; do pause; done
   kill -0 $run 2>/dev/null || fail 'a claimed folder: the run did not wait'
   same both two || fail 'a claimed folder: it was changed'
   echo go >go
   wait $run || fail "a claimed folder: exit $?"
   wait $holder
   same both one || fail 'a claimed folder: not the new tables'

   # a signal ends the wait
   rm is-held go
   flock both/.atrito.lock sh -c 'echo held >is-held; until [ -e go ]; do sleep 0.02 2>/dev/null || sleep 1; done' &
   holder=$!
   until [ -s is-held ]; do pause; done
   "$atrito" "$deck" --refine 2 -o both --quiet --set nu=0.4 2>err >out &
   run=$!
   until grep -q 'wait  another run' err || ! kill -0 $run 2>/dev/null; do pause; done
   kill -TERM $run
   wait $run
   code=$?
   [ $code -eq 143 ] || fail "a signal while waiting: exit $code, expected 143"
   echo go >go
   wait $holder
   same both one || fail 'a signal while waiting: the folder was changed'

   # a killed run leaves no claim
   "$atrito" "$deck" --refine 5 -o both --quiet 2>err >out &
   run=$!
   kill -KILL $run
   wait $run 2>/dev/null
   timeout 120 "$atrito" "$deck" --refine 2 -o both --quiet --set nu=0.4 2>err >out || fail 'a killed run: the folder is still claimed'

   # who may only read the folder cannot hold it: neither the folder itself, nor the file of the lock
   rm -f is-held go
   flock both sh -c 'echo held >is-held; until [ -e go ]; do sleep 0.02 2>/dev/null || sleep 1; done' &
   holder=$!
   until [ -s is-held ]; do pause; done
   timeout 120 "$atrito" "$deck" --refine 2 -o both --quiet --set nu=0.4 2>err >out || fail 'the folder is locked by a reader: the run waits'
   grep -q '^wait' err && fail 'the folder is locked by a reader: the run waits for it'
   echo go >go
   wait $holder
fi
[ ! -e both/.atrito.lock ] || fail 'the file of the lock is left'
"$atrito" "$deck" --refine 6 -o both --quiet 2>err >out &
run=$!
until [ -e both/.atrito.lock ] || ! kill -0 $run 2>/dev/null; do pause; done
case $(ls -l both/.atrito.lock 2>/dev/null | cut -c 1-10) in *r*) fail 'the file of the lock can be read' ;; esac
wait $run

# two sweeps: the runs of one of them
"$atrito" sweep "$deck" -o sweep-1 --quiet --vary nu=0.1,0.2,0.3 --set q=1 || fail 'the sweep itself fails'
"$atrito" sweep "$deck" -o sweep-2 --quiet --vary nu=0.1,0.2,0.3 --set q=2 || fail 'the sweep itself fails'
for i in 1 2 3; do
   rm -rf both
   "$atrito" sweep "$deck" -o both --quiet --threads 2 --vary nu=0.1,0.2,0.3 --set q=1 2>err.1 >out.1 &
   first=$!
   "$atrito" sweep "$deck" -o both --quiet --threads 2 --vary nu=0.1,0.2,0.3 --set q=2 2>err.2 >out.2 &
   second=$!
   wait $first || { fail "sweeps $i: exit $?"; cat err.1; }
   wait $second || { fail "sweeps $i: exit $?"; cat err.2; }
   matches=0
   for one in sweep-1 sweep-2; do
      whole=yes
      for nu in 0.1 0.2 0.3; do same both/nu_$nu $one/nu_$nu || whole=no; done
      [ $whole = no ] || matches=$((matches + 1))
   done
   [ $matches -eq 1 ] || fail "sweeps $i: a mixture"
done

row 'two runs into one folder, ten times at once' 'the tables of one' "$([ "$failures" -eq 0 ] && echo 'the tables of one' || echo failed)"

finish
