. "$(dirname "$0")/../lib.sh"
cp "$here"/*.inp .
# told NAME DECK QUANTITY VALUE OPTIONS: W-LARGE with its number, on the screen, in the listing and in summary.tab.
told() {
   name=$1 deck=$2 quantity=$3 value=$4
   shift 4
   run 0 "$deck" "$name" "$@"
   says "$name" "$name.err" 'W-LARGE'
   says "$name: screen" "$name.out" 'W-LARGE'
   says "$name: listing" "$name"/*.lst 'W-LARGE'
   near "$name" "$(summary "$name" "large_$quantity")" "$value" 1e-8
   [ "$(grep -c '^[^#]* large_' "$name/summary.tab")" -eq 1 ] || complain "$name: something else is large, too"
}
# silent NAME DECK OPTIONS: no warning at all.
silent() {
   name=$1 deck=$2
   shift 2
   run 0 "$deck" "$name" "$@"
   ! grep -q warning "$name.err" || complain "$name: a warning"
   ! grep -q 'W-LARGE' "$name.out" || complain "$name: on the screen"
   ! grep -q ' large_' "$name/summary.tab" || complain "$name: in the summary"
}

# The largest strain is that of the uniform compression, p/E.
silent strain-below scene.inp --set p=49.9
told strain scene.inp strain 0.0501 --set p=50.1
# A soft block sinks by eleven of its heights.
told sinks scene.inp strain 11 --set E=1 --set p=11

silent turn-below turned.inp --set w=0.0999
told turn turned.inp rotation 0.1001 --set w=0.1001
sed 's/TYPE=CPE4/TYPE=CPE9/' turned.inp >turned-q2.inp
silent turn-q2-below turned-q2.inp --set w=-0.0999
told turn-q2 turned-q2.inp rotation 0.1001 --set w=-0.1001

silent slip-below scene.inp --set drag=0.0499
told slip scene.inp slip 0.0501 --set drag=0.0501
# Forty faces a side, one of them 0.025 long: the mesh does not matter, the length of the contact does.
sed 's/NX=4/NX=40/' scene.inp >fine.inp
silent fine-below fine.inp --set drag=-0.0499
told fine fine.inp slip 0.0501 --set drag=-0.0501
# Energies add up: without friction what is stored is half of the work; dragged, a closed point is closed.
grep -Eq 'the energy and these works [.]+ agree to [0-9.]+e-1[1-9] ' fine/fine.lst || complain 'fine: the energies do not agree'
says 'fine: states' fine.out '0 open, 41 closed'
says 'fine: states, listing' fine/fine.lst 'closed points .................... 41'

# Bodies that are carried along: no forces, and no stresses of round-off.
sed 's/^UPPER-TOP, 1, 1, <drag>/&\nUPPER-TOP, 2, 2, 0.3/' scene.inp >carried.inp
run 0 carried.inp carried --set p=0 --set drag=0.01 --set gap=0.1
says 'carried: the pair' carried.err '[N-OPEN] a pair that never closes: UPPER-BOTTOM on LOWER-TOP'
says 'carried: the screen' carried.out 'no forces act; the contact law holds'
near 'carried: stress' "$(awk '$2 == "mises" { print $3 }' carried/extremes.tab)" 0 0
near 'carried: residual' "$(summary carried equilibrium_residual)" 0 0

# The listing can be handed in: 80 columns, the deck (of a long one both ends), parameters as written, tables or their extremes, the
# moments of all sums, nothing that is round-off, the names of units.
{
   printf '*UNITS\nm, kN\n'
   cat fine.inp
   awk 'BEGIN { for (i = 1; i <= 300; i++) print "** comment " i (i == 300 ? " that is much longer than a line of the listing, and is cut there in the end" : "") }' </dev/null
} >long.inp
run 0 long.inp long --set drag=0.01
listing=long/long.lst
[ -z "$(awk 'length($0) > 80' $listing)" ] || complain 'the listing is wider than 80 columns'
says 'listing: the deck' $listing 'A block on another one'
says 'listing: both ends' $listing '... the lines between are in long.run.inp'
says 'listing: the last line' $listing '** comment 300 that is much longer than a line of the listing, and is cut ther..'
! grep -q 'comment 150$' $listing || complain 'listing: the middle of the deck'
grep -Eq '^   high +1 \+ gap \+ tilt +1$' $listing || complain 'listing: a parameter as it was written'
grep -Eq '^   drag +by --set, not 0 +0.01$' $listing || complain 'listing: a parameter of --set'
says 'listing: a long table' $listing 'nodes: a row a node; 246 rows, in nodes.tab'
grep -Eq '^   u1 \[m\] +0 +[0-9]+ +0.01 +[0-9]+$' $listing || complain 'listing: the extremes of a table'
grep -Eq '^ +41 +1 +1 +0 +1 +0 +0.01 +2$' $listing || complain 'listing: a short table'
grep -Eq '^   reactions of the supports +0 +1 +0.5$' $listing || complain 'listing: a sum and its moment, without round-off'
grep -Eq '^   sum +0 +0 +0$' $listing || complain 'listing: the balance'
grep -q '\[kN/m^2\]' $listing && ! sed '1,/WHAT WAS UNDERSTOOD/d' $listing | grep -q '\[[^]]*[FL][^]]*\]' || complain 'listing: the names of units'

# A run that ends without results tells whose results its folder still holds.
"$atrito" fine.inp -o fine --set drag=0.01 --set E=-1 --refine 1 >older.out 2>older.err
[ $? -eq 2 ] || complain 'older: the exit code'
says older older.err 'note [N-OLDER] fine still holds the results of another run (E = 1000, here -1, drag = -0.0501, here 0.01, without options)'
tail -n 1 older.err | grep -q '^1 error in the deck' || complain 'older: the error does not come last'
"$atrito" scene.inp -o none --set E=-1 >none.out 2>none.err
! grep -q N-OLDER none.err || complain 'none: an empty folder holds nothing'

# Rounding of printed coordinates is no overlap. The warning comes before anything is solved.
silent rounding scene.inp --set gap=-1e-8
run 0 scene.inp overlap --set gap=-1e-6
says overlap overlap.err 'W-OVERLAP'
says overlap overlap.err 'by 1e-6 [L] at node'
says overlap overlap/scene.lst 'W-OVERLAP'
"$atrito" check scene.inp --set gap=-0.125 --set tilt=0.25 >check.out 2>check.err || complain 'check: the exit code'
says 'check: the overlap' check.err 'UPPER-BOTTOM and LOWER-TOP overlap before any load, by 0.08'
says 'check: the least gap' check.out 'least gap at node 17 (0.1796,'
says 'check: the greatest gap' check.out 'greatest at node 19 (0.8204, 1.0801); a negative gap is overlap'

# Loads on faces that touch, of the slave and of the master; one beside them is none.
for side in UPPER-BOTTOM LOWER-TOP; do
   sed "s/^UPPER-TOP, P.*/$side, P, <p>/" scene.inp >loaded.inp
   "$atrito" check loaded.inp >loaded.out 2>loaded.err || complain "$side: the exit code"
   says "$side" loaded.err 'W-LOADED-CONTACT'
   says "$side" loaded.err "$side, P, <p>"
   says "$side" loaded.err 'UPPER-BOTTOM / LOWER-TOP'
done
# The master is twice as long as what lies on it; faces of it are loaded within and beyond.
sed '14,15s/^1,/2,/; s/^\*DSLOAD/*DLOAD/; s/^UPPER-TOP, P.*/5, P3, <p>|8, P3, <p>/' scene.inp | tr '|' '\n' >beside.inp
"$atrito" check beside.inp >beside.out 2>beside.err || complain 'beside: the exit code'
says 'beside' beside.err 'W-LOADED-CONTACT'
says 'beside' beside.err 'at element 5:'
[ "$(grep -c 'W-LOADED' beside.err)" -eq 1 ] || complain 'beside: the face that nothing touches, too'
finish
