. "$(dirname "$0")/../lib.sh"
# limit CODE DECK [options]: measures, and expects an exit code.
limit() {
   wanted=$1
   shift
   rm -rf output
   "$atrito" "$@" --bench-limit >limit.out 2>limit.err
   found=$?
   [ "$found" -eq "$wanted" ] || { complain "$*: exit $found, expected $wanted"; cat limit.err; }
   absent output
}
# entry LABEL: a value of the page; part NAME: its wall seconds.
entry() {
   sed -n "s/^   $1 \.\.*\.\. //p" limit.out
}
part() {
   awk -v name="$1" '$1 == name { print $2 }' limit.out
}
sh "$here/../../bench/scene-p.sh" 20 >p20.inp
limit 0 p20.inp --quiet
near 'equations of scene P' "$(entry equations)" 2018 0
near 'nodes glued' "$(entry 'nodes glued to others')" 21 0
# printed to the microsecond: four roundings and that of the sum
near 'parts and sum' "$(value "$(part assemble) + $(part analyse) + $(part factor) + $(part solve)")" "$(part total)" 2.6e-6
says 'page' limit.out 'no contact was solved, nothing was written'
[ ! -s limit.err ] || complain 'quiet, and yet something was said'
limit 0 "$input/ex3-pillar-in-ground.inp" --refine 1 --set nu=0
says 'progress' limit.err 'read  '
limit 0 "$input/ex1-plate-on-rigid-support.inp" --quiet
near 'nodes on the rigid support' "$(entry 'nodes held by rigid surfaces')" 7 0
limit 1 "$here/../patch/nonmatching.inp"
says 'sides' limit.err '[E-COMMAND] --bench-limit: the sides of pair 1, UP-BOTTOM on LOW-TOP, do not match'
# the block slides on its rigid line
sed '/^11, 1$/d' "$here/../patch/rigid.inp" | sed '/^\*BOUNDARY$/d' >free.inp
limit 4 free.inp
says 'free' limit.err '[E-SINGULAR] the bodies glued together: '
sed 's/^1000\., \.3$/1000., .7/' p20.inp >wrong.inp
limit 2 wrong.inp
limit 5 none.inp
# the bench command: a row a scene in both tables; what it prints fits 100 columns
sh "$here/../../bench/run-bench.sh" -n 1 -b 0.01 -t "$atrito" 2e3 r0 >bench.out 2>bench.err || { complain 'bench'; cat bench.err; }
near 'rows of the bench' "$(grep -cE '^(A 2e3|P 2e3|ex3 r0) +[0-9]' bench.out)" 9 0
near 'displacements of scene P' "$(awk '$1 == "P" && !n++ { print $3 }' bench.out)" 2060 0
near 'contact points of scene P' "$(awk '$1 == "P" && !n++ { print $4 }' bench.out)" 21 0
near 'columns beyond 100' "$(awk 'length($0) > 100' bench.out | wc -l)" 0 0
says 'bench' bench.out 'METIS: not used'
finish
