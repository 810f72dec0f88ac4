#!/bin/sh
# Limits of a process (ulimit -v, -u, -s): at any of them a run ends, with its tables or with a word of what is missing; it never hangs and
# is never ended by a library.
#    limits.sh ATRITO DECK
. "$(dirname "$0")/lib.sh"
atrito=$1
cp "$2" "$work/deck.inp"
cd "$work" || exit 9

# judge WHAT CODE: solved, or E-MEMORY (2)
judge() {
   case $2 in
   0) [ -s out/contact.tab ] || fail "$1: exit 0 without tables" ;;
   2) grep -q 'E-MEMORY' err || { fail "$1: exit 2 without E-MEMORY"; cat err; } ;;
   *) fail "$1: exit $2"; cat err ;;
   esac
   rm -rf out
}

"$atrito" deck.inp -o out --quiet || fail 'without limits'
cp -R out free
rm -rf out
few=
many=
for kib in 40000 60000 90000 120000 140000 160000 175000 196000 200000 204000 220000 250000 300000 400000; do
   (ulimit -v $kib && exec timeout 60 "$atrito" deck.inp -o out --quiet) 2>err
   code=$?
   [ $code = 0 ] && many=$kib
   [ $code = 2 ] && few=$kib
   [ $kib -le 60000 ] && [ $code = 127 ] && continue # the program's libraries have no room
   [ $kib -le 40000 ] && [ $code = 139 ] && continue # nor the program itself: the system ends it before it begins
   judge "ulimit -v $kib" $code
done
[ -n "$few" ] && [ -n "$many" ] && [ "$few" -lt "$many" ] || fail 'ulimit -v: nothing was refused, or nothing solved'
for threads in 2 4 8; do
   for kib in 250000 400000 700000 1048576 1400000; do
      (ulimit -v $kib && exec timeout 60 "$atrito" deck.inp -o out --quiet --threads $threads) 2>err
      judge "ulimit -v $kib, $threads threads" $?
   done
done
(ulimit -v 400000 && exec timeout 60 "$atrito" deck.inp -o out --quiet --threads 8) 2>err
grep -q -- '--threads [1-7] fits' err || fail 'how many threads fit is not told'

# a library that starts a thread a processor, each with its buffer, when it is loaded
(ulimit -v 300000 && OPENBLAS_NUM_THREADS=8 exec timeout 60 "$atrito" deck.inp -o out --quiet) 2>err
judge 'ulimit -v, eight threads of OpenBLAS' $?

for kib in 64 128 256 512 1024; do
   (ulimit -s $kib && exec timeout 60 "$atrito" deck.inp -o out --quiet --threads 2) 2>err
   judge "ulimit -s $kib" $?
   (ulimit -S -s $kib && exec timeout 60 "$atrito" deck.inp -o out --quiet) 2>err
   code=$?
   [ $code = 0 ] || fail "a stack that may be larger, $kib KiB: exit $code"
   rm -rf out
done

# a limit on processes holds for others than root
if [ "$(id -u)" -eq 0 ] && command -v prlimit >/dev/null && command -v setpriv >/dev/null &&
   setpriv --reuid=54321 --regid=54321 --clear-groups true 2>/dev/null; then
   chmod 777 "$work"
   if setpriv --reuid=54321 --regid=54321 --clear-groups test -x "$atrito"; then
      for processes in 1 2 3 4 8; do
         setpriv --reuid=54321 --regid=54321 --clear-groups \
            prlimit --nproc=$processes:$processes "$atrito" deck.inp -o out --quiet --threads 4 2>err
         judge "ulimit -u $processes" $?
         [ $processes -gt 3 ] || grep -q W-THREADS err || fail "ulimit -u $processes: fewer threads are not told"
      done
   fi
fi
# stacks of threads for which there is no room
OMP_STACKSIZE=99999G timeout 60 "$atrito" "$work/deck.inp" -o out --quiet --threads 2 2>err
code=$?
[ $code = 0 ] && grep -q W-THREADS err || { fail "OMP_STACKSIZE=99999G: exit $code"; cat err; }
# a deck for which there is no memory
yes '** nothing' | head -c 70000000 >"$work/large.inp"
(ulimit -v 230000 && exec timeout 60 "$atrito" "$work/large.inp" -o out --quiet) 2>err
code=$?
[ $code = 5 ] && grep -q 'not enough memory' err || { fail "a deck larger than the memory: exit $code"; cat err; }
finish
