#!/bin/sh
# A gnuplot that does not end is ended after two minutes a picture, with all that it has started; the clock goes faster here.
#    slow_gnuplot.sh ATRITO QUICK_POLL DECK
. "$(dirname "$0")/lib.sh"
atrito=$1
quick=$2
cp "$3" "$work/deck.inp" || exit 9
cd "$work" || exit 9
mkdir bin
cat >bin/gnuplot <<'END'
#!/bin/sh
# the second picture hangs, half of it written
echo mine >"${2%.gp}.png"
echo "$2" >>"$DRAWN"
[ "$(wc -l <"$DRAWN")" -lt 2 ] || sleep 98765
END
chmod +x bin/gnuplot
DRAWN=$work/list PATH=$work/bin:$PATH LD_PRELOAD=$quick timeout 60 "$atrito" deck.inp -o out --plot --quiet >out.txt 2>err.txt
code=$?
[ $code -eq 0 ] || { fail "exit $code, expected 0"; cat err.txt; }
grep -q 'W-PLOT.*took too long' err.txt || { fail 'that gnuplot took too long is not told'; cat err.txt; }
[ -f out/nodes.tab ] || fail 'the tables are gone'
[ "$(wc -l <list)" -eq 2 ] || fail "gnuplot was started $(wc -l <list) times, expected 2: nothing is drawn after the end"
first=$(sed -n 1p list)
second=$(sed -n 2p list)
[ -f "out/plots/${first%.gp}.png" ] || fail 'the picture that was complete is gone'
[ ! -e "out/plots/${second%.gp}.png" ] || fail 'half a picture is left'
ps -e -o args= 2>/dev/null | grep -q '^sleep 98765$' && fail 'what gnuplot has started goes on'
[ ! -e out/.atrito.lock ] || fail 'the lock is left'

# one that ends in time is not disturbed
sed -i 's/sleep 98765/:/' bin/gnuplot
rm list
DRAWN=$work/list PATH=$work/bin:$PATH timeout 60 "$atrito" deck.inp -o out --plot --quiet >out.txt 2>err.txt || fail "a quick gnuplot: exit $?"
grep -q 'took too long' err.txt && fail 'a quick gnuplot took too long'
finish
