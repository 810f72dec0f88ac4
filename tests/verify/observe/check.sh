. "$(dirname "$0")/../lib.sh"
# value_of FOLDER NAME: what is observed at the end
value_of() {
   summary "$1" "$2" | tail -1
}

# refused DECK EXPRESSION TEXT ...: exit 1 before anything is solved, and what is said
refused() {
   bad=$1
   expression=$2
   shift 2
   rm -rf refused
   "$atrito" "$bad" -o refused --quiet --observe "$expression" >refused.out 2>refused.err
   code=$?
   [ "$code" -eq 1 ] || complain "$expression: exit $code, expected 1"
   for text; do says "$expression" refused.err "$text"; done
   absent refused
}

# A bar of 4 x 1 under tension s = 8: u1 = 8 x/E, elements of length 1 and 3.
cat >bar.inp <<'END'
*PARAMETER
E = 1000
s = 8
*NODE, NSET=ALL
1, 0, 0
2, 1, 0
3, 4, 0
4, 0, 1
5, 1, 1
6, 4, 1
*NODE
99, 9, 9
*NSET, NSET=LINE
1, 2, 3
*NSET, NSET=MID
2
*NSET, NSET=LEFT
1, 4
*ELEMENT, TYPE=CPS4, ELSET=BAR
1, 1, 2, 5, 4
2, 2, 3, 6, 5
*ELSET, ELSET=LONG
2
*MATERIAL, NAME=M
*ELASTIC
<E>, 0.25
*SOLID SECTION, ELSET=BAR, MATERIAL=M
0.5
*SURFACE, NAME=BOTTOM
BAR, S1
*BOUNDARY
LEFT, 1
1, 2
*STEP
*STATIC
*DLOAD
2, P2, <-s>
*END STEP
END
run 0 bar.inp bar --digits 17 --proof off --observe 'mid=u1(MID)*E/s' --observe 'end=u1( 3 )/4' --observe 'up=u2(5)' --observe 'far=u(6)' \
   --observe 'of_line=mean(u1, LINE)' --observe 'of_face=mean(u1,bottom)' --observe 'of_body=mean(u1,BAR)' \
   --observe 'of_long=MEAN(u1,LONG)' --observe 'least=min(u1,LONG)' --observe 'most=max(u1,BAR)' \
   --observe 'sx=s11(2)' --observe 'vm=max(mises,BAR)' --observe 'sy=max(s22,BAR)+max(s12,BAR)+max(s33,BAR)' \
   --observe 'pull=rf1(LEFT)' --observe 'one=rf1(1)' --observe 'up_force=rf2(LEFT)' \
   --observe 'energy=external_work/2/strain_energy' --observe 'angle=sin(30*deg)*max(1, E/2, min(2,3))' --observe 'clock=time'
near 'u1 of a set of one node, with parameters' "$(value_of bar mid)" 1 1e-12
near 'u1 of a node' "$(value_of bar end)" 0.008 1e-14
near 'u2 of a node' "$(value_of bar up)" -0.002 1e-14
near 'length of a displacement' "$(value_of bar far)" "$(value 'sqrt(0.032^2 + 0.002^2)')" 1e-14
near 'mean over a node set' "$(value_of bar of_line)" "$(value '0.008*5/3')" 1e-14
near 'mean over a surface' "$(value_of bar of_face)" 0.016 1e-14
near 'mean over an element set' "$(value_of bar of_body)" 0.016 1e-14
near 'mean over one of the elements' "$(value_of bar of_long)" 0.02 1e-14
near 'least value' "$(value_of bar least)" 0.008 1e-14
near 'largest value' "$(value_of bar most)" 0.032 1e-14
near 'stress of a node' "$(value_of bar sx)" 8 1e-11
near 'largest von Mises stress' "$(value_of bar vm)" 8 1e-11
near 'no other stresses' "$(value_of bar sy)" 0 1e-11
near 'reaction of a set' "$(value_of bar pull)" -4 1e-12
near 'reaction of a node' "$(value_of bar one)" -2 1e-12
near 'no reaction along y' "$(value_of bar up_force)" 0 1e-12
near 'energy and work' "$(value_of bar energy)" 1 1e-12
near 'arithmetic' "$(value_of bar angle)" 250 1e-12
near 'time' "$(value_of bar clock)" 1 0
says 'on the screen' bar.out 'observed     mid = 1, end = 0.008'
says 'in the listing' bar/bar.lst 'of face .......................... 0.016'

# Nothing but these rows is new.
run 0 bar.inp plain --digits 17 --quiet --proof off
grep -v '^# ' bar/summary.tab | awk 'NR <= 6 { $1 = $1; print }' >some
grep -v '^# ' plain/summary.tab | awk '{ $1 = $1; print }' >all
[ "$(wc -l <all)" -eq 6 ] || complain 'quantities of a run without contact'
cmp -s some all || complain '--observe changes other rows'

# Wider elements, a refined mesh: nodes keep their numbers, sets and surfaces follow.
run 0 bar.inp fine --digits 17 --quiet --refine 2 --observe 'mid=u1(MID)' --observe 'of_face=mean(u1,BOTTOM)' --observe 'end=u1(3)' \
   --observe 'of_line=mean(u1,LINE)'
near 'refined: a node' "$(value_of fine mid)" 0.008 1e-13
near 'refined: mean over a surface' "$(value_of fine of_face)" 0.016 1e-13
near 'refined: the end' "$(value_of fine end)" 0.032 1e-13

# A study of it: the closed form is met at every level.
rm -rf study
"$atrito" study bar.inp -o study --levels 3 --observe 'tip=u1(3)' --observe 'm=mean(u1,BOTTOM)' --reference tip=0.032 \
   >study.out 2>study.err || complain 'a study'
all_near 'values of a study' study/study.tab tip 0.032 1e-10
all_near 'errors of a study' study/study.tab tip_error 0 1e-10
all_near 'a quantity without reference' study/study.tab m 0.016 1e-10
all_near 'and its errors' study/study.tab m_error 0 1e-10
grep -q m_order study/study.tab || complain 'no order'
grep -q strain_energy study/study.tab && complain 'strain_energy is studied unasked'
rm -rf study2
"$atrito" study bar.inp -o study2 --levels 2 --observe 'tip=u1(3)' >study2.out 2>study2.err || complain 'a study without references'
grep -q 'tip tip_error tip_order strain_energy' study2/study.tab && complain 'columns of a study'
[ "$(grep '^# columns' study2/study.tab | awk '{ print $9, $12 }')" = 'tip strain_energy' ] || complain 'what is observed comes first'

# A sweep: the rows, a column for every row, and the ends in runs.tab and on the screen.
rm -rf sweep
"$atrito" sweep bar.inp -o sweep --vary s=1,4,8 --observe 'tip=u1(3)*E' --observe 'ratio=u1(3)/s' --digits 17 >sweep.out 2>sweep.err ||
   complain 'a sweep'
near 'a row of sweep.tab' "$(awk '!/^#/ && $1 == 4 && $4 == "tip" { print $5 }' sweep/sweep.tab)" 16 1e-11
[ "$(awk '!/^#/ && $1 == 4 && ($7 < 15.999 || $7 > 16.001)' sweep/sweep.tab | wc -l)" -eq 0 ] || complain 'the column of sweep.tab'
all_near 'a ratio' sweep/sweep.tab ratio 0.004 1e-14
near 'the first run' "$(column sweep/runs.tab tip | head -1)" 4 1e-11
near 'the last run' "$(column sweep/runs.tab tip | tail -1)" 32 1e-11
says 'on the screen' sweep.out 's                outer          tip        ratio     area [%]   normal [F] exit'

# A cylinder under axial pressure: u1 = nu p r/E, means are weighed by the circumference.
cat >cylinder.inp <<'END'
*BLOCK, TYPE=CAX8, ELSET=ROD, NX=3, NY=2
0, 0
2, 0
2, 1
0, 1
*MATERIAL, NAME=M
*ELASTIC
100, 0.3
*SOLID SECTION, ELSET=ROD, MATERIAL=M
*BOUNDARY
ROD-LEFT, 1
ROD-BOTTOM, 2
*STEP
*STATIC
*DSLOAD
ROD-TOP, P, 10
*END STEP
END
run 0 cylinder.inp cylinder --digits 17 --quiet --observe 'top=mean(u1,ROD-TOP)' --observe 'all=mean(u1,ROD)' \
   --observe 'most=max(u1,ROD-TOP)' --observe 'down=rf2(ROD-BOTTOM)' --observe 'corner=u1(ROD-TOP-RIGHT)' --observe 'half=u1(ROD-CENTRE)'
near 'mean over the end of a cylinder' "$(value_of cylinder top)" 0.04 1e-13
near 'mean over a cylinder' "$(value_of cylinder all)" 0.04 1e-13
near 'its largest radial displacement' "$(value_of cylinder most)" 0.06 1e-13
near 'a corner of a block' "$(value_of cylinder corner)" 0.06 1e-13
near 'the middle of a block' "$(value_of cylinder half)" 0.03 1e-13
near 'its support' "$(value_of cylinder down)" "$(value '10*4*atan2(0,-1)')" 1e-10

# A history in which only the end is printed: every increment is observed, stresses too.
sed 's/^\*STATIC/*STATIC\n0.25, 1/' bar.inp >steps.inp
run 0 steps.inp steps --digits 17 --quiet --proof off --observe 'tip=u1(3)' --observe 'vm=max(mises,BAR)' --observe 'err=error_estimate_percent'
[ "$(column steps/history.tab increment | tr '\n' ' ')" = '1 2 3 4 ' ] || complain 'increments of history.tab'
[ "$(grep -v '^#' steps/summary.tab | wc -l)" -eq 9 ] || complain 'only the end is printed'
for i in 1 2 3 4; do
   near "increment $i" "$(column steps/history.tab tip | sed -n ${i}p)" "$(value "0.008*$i")" 1e-13
   near "stress of increment $i" "$(column steps/history.tab vm | sed -n ${i}p)" "$(value "2*$i")" 1e-11
done

# Contact: quantities of pairs, fields of points, columns of history.tab beside the others; the same behind a restart.
cat >push.inp <<'END'
*BLOCK, TYPE=CPE4, ELSET=LOW, NX=4, NY=2
0, -1
4, -1
4, 0
0, 0
*BLOCK, TYPE=CPE4, ELSET=MID, NX=3, NY=2
1, 0
3, 0
3, 1
1, 1
*BLOCK, TYPE=CPE4, ELSET=TOP, NX=2, NY=1
1.5, 1
2.5, 1
2.5, 2
1.5, 2
*MATERIAL, NAME=M
*ELASTIC
1000, 0.25
*SOLID SECTION, ELSET=LOW, MATERIAL=M
*SOLID SECTION, ELSET=MID, MATERIAL=M
*SOLID SECTION, ELSET=TOP, MATERIAL=M
*SURFACE INTERACTION, NAME=JOINT
*FRICTION
0.5
*CONTACT PAIR, INTERACTION=JOINT
MID-BOTTOM, LOW-TOP
TOP-BOTTOM, MID-TOP
*BOUNDARY
LOW-BOTTOM, 1, 2
*STEP
*STATIC
0.25, 1
*BOUNDARY
TOP-TOP, 2, 2, -0.01
TOP-TOP, 1, 1, 0.002
*NODE PRINT
U
*END STEP
END
run 0 push.inp push --digits 17 --quiet --observe 'n2=normal_resultant(2)' --observe 'p1=max_pressure(MID-BOTTOM)' \
   --observe 'most=max(pressure,1)' --observe 'least=min(shear, TOP-BOTTOM)' --observe 'uniform=mean(pressure,1)*2' \
   --observe 'wide=max(u2,LOW)' --observe 'load=rf2(TOP-TOP)' --observe 'vm=max(mises,TOP)' --observe 'opening=max(gap,1)+1' \
   --observe 'searched=solutions_found' --observe 'bound=error_bound_percent'
near 'a quantity of pair 2' "$(value_of push n2)" "$(awk '$2 == 2 && $3 == "normal_resultant" { print $4 }' push/summary.tab)" 0
near 'a quantity of pair 1' "$(value_of push p1)" "$(awk '$2 == 1 && $3 == "max_pressure" { print $4 }' push/summary.tab)" 0
near 'largest pressure' "$(value_of push most)" "$(value_of push p1)" 0
near 'least shear' "$(value_of push least)" "$(awk '!/^#/ && $2 == 2 { if (n++ == 0 || $10 < m) m = $10 } END { printf "%.17g", m }' push/contact.tab)" 0
near 'mean pressure' "$(value_of push uniform)" "$(awk '$2 == 1 && $3 == "normal_resultant" { print $4 }' push/summary.tab)" 1e-12
near 'reaction and resultant' "$(value_of push load)" "$(value "-($(value_of push n2))")" 1e-9
near 'a bound of the error' "$(value_of push bound)" "$(summary push error_bound_percent | tail -1)" 0
[ "$(value_of push searched)" = nan ] || complain 'solutions are counted without a search'
[ "$(column push/history.tab n2)" = "$(awk '!/^#/ && $4 == 2 { print $5; print $5 }' push/history.tab)" ] ||
   complain 'a column of history.tab beside that of the pair'
[ "$(column push/history.tab p1 | tail -1)" = "$(value_of push p1)" ] || complain 'history.tab and summary.tab'
# a step is added behind the one that was recorded
sed 's/^\*NODE PRINT/*RESTART, WRITE, FREQUENCY=1\n&/' push.inp >first.inp
{ cat first.inp; printf '*STEP\n*STATIC\n0.5, 1\n*BOUNDARY\nTOP-TOP, 1, 1, -0.002\n*END STEP\n'; } >both.inp
if "$atrito" check first.inp --quiet 2>hdf5.err; then
   run 0 first.inp first --digits 17 --quiet --observe 'vm=max(mises,TOP)' --observe 'n2=normal_resultant(2)'
   run 0 both.inp both --digits 17 --quiet --observe 'vm=max(mises,TOP)' --observe 'n2=normal_resultant(2)'
   run 0 both.inp resumed --digits 17 --quiet --restart first/first.restart.h5 --observe 'vm=max(mises,TOP)' \
      --observe 'n2=normal_resultant(2)'
   [ "$(grep -vc '^#' both/history.tab)" -eq 12 ] || complain 'rows of both steps'
   "$atrito" compare both resumed --rtol 0 >compare.out || { complain 'a restart changes what is observed'; cat compare.out; }
   run 2 both.inp other --digits 17 --quiet --restart first/first.restart.h5 --observe 'n2=normal_resultant(2)'
   says 'other observations' other.err '--observe n2=normal_resultant(2)'
else
   says 'without HDF5' hdf5.err 'E-NOT-BUILT'
fi

# What has no value is nan, and told once.
run 0 steps.inp nan --observe 'inverse=1/(u1(3)-u1(6))' --observe 'root=sqrt(-u1(3))'
[ "$(column nan/history.tab root | sort -u)" = nan ] || complain 'a root of a negative number'
[ "$(value_of nan root)" = nan ] || complain 'nan in summary.tab'
[ "$(grep -c 'W-OBSERVE.*root' nan.err)" -eq 1 ] || complain 'a nan is told once'
says 'the place of a nan' nan.err '--observe root is nan in step 1, increment 1: sqrt of a negative number, column 1 of sqrt(-u1(3))'

# Faults of the command line.
refused bar.inp 'tip=u1(33)' 'error [E-OBSERVE] --observe tip: node 33 does not exist, column 4' 'expected: a node number'
refused bar.inp 'tip=2*u1(MIDD)' 'the deck has no set or surface MIDD, column 6' 'nearest:  MID' '         ^~~~'
refused bar.inp 'tip=u1(LINE)' 'LINE has 3 nodes, column 4' 'mean(u1, LINE)'
refused bar.inp 'tip=u3(3)' 'unknown quantity u3, column 1' 'nearest:  u1, u2, u'
refused bar.inp 'tip=max(misses,BAR)' 'unknown quantity misses, column 5' 'nearest:  mises'
refused bar.inp 'tip=mean(misses,BAR)' 'unknown quantity misses, column 6' 'nearest:  mises'
refused bar.inp 'tip=mean(u1)' 'mean stands with 1 argument, column 1' 'expected: mean(u1, set)'
refused bar.inp 'tip=mean' 'mean stands without argument'
refused bar.inp 'tip=u1(1,2)' '(1, 2) is outside of all bodies, 1 from BAR, column 1' 'expected: a place x, y in a body'
refused bar.inp 'tip=u1(1,1,BARR)' 'the deck has no element set or instance BARR, column 8' 'nearest:  BAR'
refused bar.inp 'tip=u1(1,1,LONG)+u1(0,1,LONG)' '(0, 1) is outside of LONG, 1 from BAR, column 14'
refused bar.inp 'tip=u1(1,1,BAR,2)' 'u1 stands with 4 arguments' 'u1(x, y, element set or instance)'
refused bar.inp 'tip=u1(1,LINE)' 'unknown name LINE, column 6' 'a coordinate [L]'
refused bar.inp 'tip=s_rr(1,1,2,3,BARR)' 'the deck has no element set or instance BARR, column 14'
refused bar.inp 'tip=mean(s_rr,BAR,1)' 'mean stands with 3 arguments' 'with xc, yc behind it about a centre'
refused bar.inp 'tip=rf1(1,1)' 'rf1 stands with 2 arguments'
refused bar.inp 'tip=contact_half_width' 'the deck has no contact pair'
refused bar.inp 'tip=u1' 'u1 stands without argument'
refused bar.inp 'tip=strain_energy(1)' 'strain_energy is one number of the step'
refused bar.inp 'tip=max_pressure' 'the deck has no contact pair'
refused push.inp 'tip=u2(1.5,0)' '(1.5, 0) is in LOW and in MID, column 1' 'expected: x, y and the element set or instance'
refused push.inp 'tip=closing_time' 'of which of the 2 pairs?'
refused push.inp 'tip=max_pressure' 'of which of the 2 pairs?' '1 to 2'
refused push.inp 'tip=max_pressure(3)' 'pair 3 does not exist, column 14'
refused push.inp 'tip=max_pressure(TOP-BOTOM)' 'no pair has the slave TOP-BOTOM' 'nearest:  TOP-BOTTOM'
refused push.inp 'tip=max_pressure(1,2)' 'max_pressure stands with 2 arguments'
refused push.inp 'tip=max(pressure,1,2)' 'max stands with 3 arguments'
refused push.inp 'tip=pressure' 'pressure has a value at each contact point'
refused bar.inp 'tip=rf1(6)' '6 has no node with a prescribed displacement'
refused bar.inp 'tip=mises(99)' '99 has a node without elements'
refused bar.inp 'tip=1/0/0+u9(2)' 'unknown quantity u9, column 7'
refused bar.inp 'tip=2*(3' "')' is missing, column 5"
refused bar.inp 'tip=' 'the expression ends too early'
refused bar.inp 'u1=u1(3)' 'u1 is a quantity or function already'
refused bar.inp 'strain_energy=u1(3)' 'strain_energy is a quantity or function already'
refused bar.inp 'E=u1(3)' 'E is a parameter of the deck'
refused bar.inp 'value=u1(3)' 'value is a column of the tables already'
refused bar.inp 'open=u1(3)' 'open is a column of the tables already'
refused bar.inp '2nd=u1(3)' '2nd is no name'
refused bar.inp 'a_name_of_thirty_three_characters=u1(3)' 'is no name'
refused bar.inp 'tip' '--observe tip is not possible'
rm -rf twice
"$atrito" bar.inp -o twice --quiet --observe 'tip=u1(3)' --observe 'TIP=u2(3)' 2>twice.err && complain 'a name that is given twice'
says 'twice' twice.err 'TIP is given twice'
absent twice
"$atrito" check bar.inp --quiet --observe 'tip=u1(33)' 2>check.err && complain 'check takes a wrong expression'
"$atrito" check bar.inp --quiet --observe 'tip=u1(3)' 2>check.err || complain 'check refuses a sound expression'
"$atrito" study bar.inp --levels 2 -o bad --observe 'tip=u1(3)' --reference tpi 2>study.err && complain 'a reference that is not observed'
says 'a reference' study.err '--reference tpi: summary.tab has no such quantity; nearest: tip'
finish
