. "$(dirname "$0")/../lib.sh"
program=$4
# limit CODE DECK [options]: measures, and expects an exit code.
limit() {
   wanted=$1
   shift
   "$program" "$@" >limit.out 2>limit.err
   found=$?
   [ "$found" -eq "$wanted" ] || { complain "$*: exit $found, expected $wanted"; cat limit.err; }
}
# entry LABEL: a value of the page; part NAME: its wall seconds.
entry() {
   sed -n "s/^   $1 \.\.*\.\. //p" limit.out
}
part() {
   awk -v name="$1" '$1 == name { print $2 }' limit.out
}
sh "$here/../../bench/scene-p.sh" 20 >p20.inp
limit 0 p20.inp
near 'equations of scene P' "$(entry equations)" 2018 0
near 'nodes glued' "$(entry 'nodes glued to others')" 21 0
# printed to the microsecond: five roundings and that of the sum
near 'phases and sum' "$(value "$(part assemble) + $(part order) + $(part analyse) + $(part factor) + $(part solve)")" "$(part total)" 3.1e-6
[ ! -s limit.err ] || complain 'something was said'
operations=$(entry 'operations of the factor')
largest=$(entry 'largest displacement of them')
says 'order' limit.out 'minimum degree (AMD)'
others='--numbering=backward --numbering=bodies'
[ "$("$program" p20.inp --count | grep -c '^metis')" -eq 0 ] || others="$others --ordering=metis"
for other in $others; do
   limit 0 p20.inp "${other%=*}" "${other#*=}"
   # four digits are printed
   near "$other" "$(entry 'largest displacement of them')" "$largest" "$(value "1e-4*$largest")"
   [ "$(entry 'operations of the factor')" != "$operations" ] || complain "$other: the same order"
done
limit 0 p20.inp --count
near 'numberings counted' "$(grep -c '^amd ' limit.out)" 3 0
limit 0 "$input/ex3-pillar-in-ground.inp" --refine 1 --set nu=0
limit 0 "$input/ex1-plate-on-rigid-support.inp"
near 'nodes on the rigid support' "$(entry 'nodes held by rigid surfaces')" 7 0
limit 1 "$here/../patch/nonmatching.inp"
says 'sides' limit.err '[E-COMMAND] the sides of pair 1, UP-BOTTOM on LOW-TOP, do not match'
for wrong in '--ordering nd' '--numbering up' '--refine x' '--threads 2' '--set' 'another.inp'; do
   # two words
   limit 1 p20.inp $wrong
   says "$wrong" limit.err 'usage: limit DECK.inp'
done
# the block slides on its rigid line
sed '/^11, 1$/d' "$here/../patch/rigid.inp" | sed '/^\*BOUNDARY$/d' >free.inp
limit 4 free.inp
says 'free' limit.err '[E-SINGULAR] the bodies are free to move although glued together'
sed 's/^1000\., \.3$/1000., .7/' p20.inp >wrong.inp
limit 2 wrong.inp
limit 5 none.inp
# the bench command: a row a scene in both tables; what it prints fits 100 columns
sh "$here/../../bench/run-bench.sh" -n 1 -b 0.01 -t "$atrito" 2e3 r0 >bench.out 2>bench.err || { complain 'bench'; cat bench.err; }
near 'rows of the bench' "$(grep -cE '^(A 2e3|P 2e3|ex3 r0) +[0-9]' bench.out)" 9 0
near 'displacements of scene P' "$(awk '$1 == "P" && !n++ { print $3 }' bench.out)" 2060 0
near 'contact points of scene P' "$(awk '$1 == "P" && !n++ { print $4 }' bench.out)" 21 0
near 'columns beyond 100' "$(awk 'length($0) > 100' bench.out | wc -l)" 0 0
says 'bench' bench.out 'limit: the better of AMD and METIS'
finish
