# Limits of scenes by `atrito limit`: blocks and arches against closed forms and limit analysis; tables, pictures, errors.
. "$(dirname "$0")/../lib.sh"

# limit CODE FOLDER DECK [options]: leaves FOLDER.out and FOLDER.err
limit() {
   wanted=$1
   folder=$2
   deck=$3
   shift 3
   rm -rf "$folder"
   "$atrito" limit "$deck" -o "$folder" "$@" >"$folder.out" 2>"$folder.err"
   found=$?
   [ "$found" -eq "$wanted" ] || { complain "limit $deck $*: exit $found, expected $wanted"; cat "$folder.err"; }
}

# bound FOLDER WORD: the value behind a word ('stands at', 'falls at') of limit.tab
bound() {
   sed -n "s/^# .*$2 \\([-0-9.e+]*\\).*/\\1/p" "$1/limit.tab"
}

# between FOLDER LIMIT TOLERANCE: both bounds are the limit, within the tolerance of it, and different; the table has them so.
between() {
   near "$1: stands" "$(bound "$1" 'stands at')" "$2" "$(value "$3*($2)")"
   near "$1: falls" "$(bound "$1" 'falls at')" "$2" "$(value "$3*($2)")"
   [ "$(bound "$1" 'stands at')" != "$(bound "$1" 'falls at')" ] || complain "$1: both bounds are the same"
   awk -v stands="$(bound "$1" 'stands at')" -v falls="$(bound "$1" 'falls at')" '
      /^#/ { next }
      { n++; if (n > 1 && $1 <= last) { print "rows are not in their order"; exit 1 }
        last = $1
        side = (falls > stands) ? $1 - stands : stands - $1
        gap = (falls > stands) ? falls - stands : stands - falls
        if (side < 1e-10 && side > -1e-10 && $2 != 0) { print "what stands has code " $2; exit 1 }
        if (side < -1e-3*gap && $2 == 4) { print "falls before what stands: " $1; exit 1 }
        if (side > 0.999*gap && $2 != 4) { print "does not fall behind what falls: " $1; exit 1 }
        if ($2 == 0) { solved++; if ($4 ~ /nan/) { print "no displacement at " $1; exit 1 } }
        if ($2 == 4 && !($3 > 0)) { print "falls without excess: " $1; exit 1 } }
      END { if (solved < 10) { print "solved values: " solved; exit 1 } }' "$1/limit.tab" || complain "$1: limit.tab"
   awk 'length($0) > 79 { print; bad = 1 } END { exit bad }' "$1.out" || complain "$1: lines of more than 79 columns"
}

# motion FOLDER BODY COLUMN: of mechanism.tab
motion() {
   awk -v name="$3" -v body="$2" '/^# columns:/ { for (i = 3; i <= NF; i++) if ($i == name) k = i - 2 }
      !/^#/ && $2 == body { print $k }' "$1/mechanism.tab"
}

# a block on a slope: nu, with one factorisation in all, and the slope itself, which makes new bodies
limit 0 nu "$here/slope.inp" --vary nu=0.1:0.9 --digits 17
between nu "$(value 'sin(0.5)/cos(0.5)')" 1e-6
says 'nu: factored once' nu.out '1 factorisation'
tr '\n' ' ' <nu.out >nu.line
says 'nu: what it says' nu.line 'body BLOCK (node 6 and all others) is free to move along (-0.877583, -0.479426)'
near 'nu: slides down' "$(motion nu BLOCK u2)" "$(value '-sin(0.5)')" 1e-6
near 'nu: and does not turn' "$(motion nu BLOCK rotation)" 0 1e-6
near 'nu: factorisations' "$(column nu/limit.tab factorisations | awk '{ n += $1 } END { print n }')" 1 0
limit 0 alpha "$here/slope.inp" --vary alpha=0.1:1
between alpha "$(value 'atan2(0.7, 1)')" 1e-6
# expressions as ends, and another tolerance
limit 0 coarse "$here/slope.inp" --vary 'nu=1/10:2*0.45' --tolerance 1e-2
between coarse "$(value 'sin(0.5)/cos(0.5)')" 1e-2
[ "$(grep -vc '^#' coarse/limit.tab)" -lt "$(grep -vc '^#' nu/limit.tab)" ] || complain 'a coarse tolerance takes as many values'

# a block that tips, or slides; what is watched is the displacement of a run with that value
limit 0 tip "$here/tip.inp" --vary H=0:1 --watch 35,1 --digits 17 --observe 'seen=u1(35)'
[ "$(awk '!/^#/ && $2 == 0 { print $4 - $8 }' tip/limit.tab | sort -u)" = 0 ] || complain 'tip: what is observed'
[ "$(awk '!/^#/ && $2 == 4 { print $8 }' tip/limit.tab | sort -u)" = nan ] || complain 'tip: what is observed without a run'
between tip "$(value '1/3')" 1e-6
near 'tip: about its corner' "$(value "$(motion tip POST u1) + 1.5*($(motion tip POST rotation))")" 0 1e-8
near 'tip: half as much down' "$(value "$(motion tip POST u2) + 0.5*($(motion tip POST rotation))")" 0 1e-8
says 'tip: what is watched' tip.out 'u1 of node 35'
sed 's/^\*END STEP/*NODE PRINT\nU\n&/' "$here/tip.inp" >printed.inp
middle=$(awk '!/^#/ && $2 == 0 && $1 > 0.1 && $1 < 0.2 { print $1, $4; exit }' tip/limit.tab)
run 0 printed.inp printed --set "H=${middle% *}" --digits 17 --quiet
near 'tip: displacement of the curve' "${middle#* }" "$(awk '!/^#/ && $2 == 35 { print $5 }' printed/nodes.tab)" 1e-14
limit 0 slide "$here/tip.inp" --vary H=0:1 --set nu=0.2 --quiet
between slide 0.2 1e-6
near 'slide: along the floor' "$(motion slide POST u1)" 1 1e-6
[ -s slide.out ] && complain '--quiet prints'

# histories: the second of three steps is too much, or the peak of an amplitude in it; the run that falls says when
for form in dense sparse; do
   limit 0 push-$form "$here/push.inp" --vary H=0.1:8 --contact $form
   between push-$form 4.2 1e-6
done
says 'push: when' push-dense.out 'mechanism: in step 2, at time 2: body BLOCK'
near 'push: factored once' "$(column push-dense/limit.tab factorisations | awk '{ n += $1 } END { print n }')" 1 0
awk '!/^#/ && $2 == 0 && !($5 >= 9 && $6 > $5) { exit 1 }' push-dense/limit.tab || complain 'push: iterations of all increments'
awk '/^push$/ { second = 1 } /^back$/ { second = 0 } second { sub(/^\*DLOAD/, "*DLOAD, AMPLITUDE=UPS") } { print }' "$here/push.inp" >peak.inp
limit 0 peak peak.inp --vary peak=0.6:8
between peak "$(value '4.2')" 1e-6
says 'peak: when' peak.out 'mechanism: in step 2, at time 1.35: body BLOCK'
# the pressure comes behind the push: at the end all would be well
sed -e '/^\*DSLOAD/,+1d' -e 's/^0.25, 1$/0.25, 1\n*DSLOAD, AMPLITUDE=LATE\nBLOCK-TOP, P, 5/' -e '/^back$/,$d' "$here/push.inp" |
   sed -e '$d' -e 's/^\*AMPLITUDE, NAME=UPS/*AMPLITUDE, NAME=LATE\n0, 0, 0.5, 0, 1, 1\n&/' >late.inp
limit 0 late late.inp --vary H=0.1:8
between late 2.4 1e-6
says 'late: when' late.out 'at time 1.5'
"$atrito" "$here/push.inp" --set H=5 -o fallen --quiet >/dev/null 2>&1
[ $? -eq 4 ] || complain 'push with H = 5: exit code'
says 'push with H = 5' fallen/contact.tab '# NOT CONVERGED: ended in step 2, increment'
near 'push with H = 5: when' "$(awk '!/^#/ { t = $3 } END { print t }' fallen/history.tab)" 1.84 1e-5

# arches
for n in 9 20; do
   awk -v n=$n -f "$here/arch.awk" >arch-$n.inp
   limit 0 t-$n arch-$n.inp --vary t=0.05:0.2
   limit 0 nu-$n arch-$n.inp --vary nu=0.1:1
done
between t-9 0.1015254676 1e-6
between t-20 0.1073477445 1e-6
between nu-9 0.3089884871 1e-6
between nu-20 0.3088770773 1e-6
near 'arch: bodies factored once' "$(column nu-9/limit.tab factorisations | awk '{ n += $1 } END { print n }')" 9 0
# the thin one: hinges at the springings, between, and at the crown, which sinks upright
near 'arch: the crown sinks' "$(motion t-9 V5 u1)" 0 1e-4
near 'arch: and does not turn' "$(motion t-9 V5 rotation)" 0 1e-4
near 'arch: the springing turns about its outer corner' \
   "$(awk '!/^#/ && $2 == "V1" { printf "%.12g", ($3 + 1.0507627)*$7 - $6 }' t-9/mechanism.tab)" 0 1e-6

# a published wall (Ferris and Tin-Loi 2001, wall 1): a static limit, and solutions with Coulomb's law up to less
{
   printf '*PARAMETER\nk = 0.63\n'
   awk -v courses=6 -v len=10 -v shift=1 -v height=0.875 -v nu=0.65 -v factor='<k>' -f "$here/../walls/wall.awk"
} >dry.inp
limit 3 dry dry.inp --vary k=0.63:0.65
near 'dry: balanced' "$(bound dry 'balanced at')" 0.6428590033 0.65e-6
near 'dry: falls' "$(bound dry 'falls at')" 0.6428590033 0.65e-6
near 'dry: stands' "$(bound dry 'stands at')" 0.6398 0.001
near 'dry: and then undecided' "$(bound dry 'proof from')" "$(bound dry 'stands at')" 1e-3
says 'dry' dry.out 'static limit 0.642859003'
says 'dry' dry.out "solved up to $(sed -n 's/^stands at *k = \([0-9.]*\):.*/\1/p' dry.out), the last value for which"
[ "$(awk '!/^#/ && ($2 == 4 || $2 == -1)' dry/limit.tab | wc -l)" -eq 2 ] || complain 'dry: the limit is not found in one step'
near 'dry: factorisations' "$(value "$(column dry/limit.tab factorisations | awk '{ n += $1 } END { print n }') < 2000")" 1 0

# points that gaps keep apart count in the balance, which is told; as is a motion that is not small
limit 3 groove "$here/groove.inp" --vary m=0.01:10 --tolerance 1e-3
tr -s '\n ' ' ' <groove.out >groove.line
says 'groove' groove.line 'counts points as touching that are up to 0.159 apart without loads; without them nothing balances'
says 'groove' groove.err 'warning [W-LARGE] where it stands, at m = '
says 'groove' groove.line 'but where it stands rotation '
limit 3 filled "$here/groove.inp" --vary m=0.01:10 --tolerance 1e-3 --set G=1
grep -q 'apart\|W-LARGE' filled.out filled.err && complain 'filled: doubts'

# runs that do not converge below the limit: an interval, code 3, and it says so
sed -e 's/^\*STATIC.*/*STATIC\n*CONTROLS, METHOD=PICARD, MAXIT=10/' "$here/../no-equilibrium/stack.inp" >slow.inp
limit 3 slow slow.inp --vary push3=0:6
read -r first <slow/limit.tab
[ "$first" = '# NOT CONVERGED' ] || complain "slow/limit.tab begins with '$first'"
tr -s '\n ' ' ' <slow.out >slow.line
says 'slow' slow.line 'neither a solution nor a proof was found (exit 3)'
says 'slow' slow.line 'static limit 3.6, '
near 'slow: falls' "$(bound slow 'falls at')" 3.6 3.6e-6
near 'slow: balanced' "$(bound slow 'balanced at')" 3.6 3.6e-6
near 'slow: stands' "$(bound slow 'stands at')" 3.3 0.25
awk '!/^#/ && $2 == 3 { n++; if (!($5 == 10)) bad = 1 } END { exit bad || n < 3 }' slow/limit.tab || complain 'slow: rows of code 3'

# pictures
limit 0 drawn arch-9.inp --vary nu=0.1:1 --plot --quiet
for stem in limit mechanism; do
   [ -s drawn/plots/$stem.gp ] && [ -s drawn/plots/$stem.dat ] || complain "drawn/plots/$stem.gp or .dat is missing"
   if command -v gnuplot >/dev/null 2>&1; then
      [ -s drawn/plots/$stem.png ] || complain "drawn/plots/$stem.png is missing"
      [ "$(grep -c '<path' drawn/plots/$stem.svg)" -gt 5 ] || complain "drawn/plots/$stem.svg shows nothing"
   fi
done
[ ! -e drawn/plots/gnuplot.log ] || { complain 'gnuplot complains'; cat drawn/plots/gnuplot.log; }
# nine bodies of four edges; the crown between its places
[ "$(grep -c '^# block' drawn/plots/mechanism.dat)" -eq 9 ] || complain 'outlines of nine bodies are drawn'
"$atrito" limit arch-9.inp -o drawn --vary nu=0.1:1 --quiet 2>/dev/null
absent drawn/plots

# what is wrong is told, and nothing is written
limit 1 wrong "$here/slope.inp" --vary nu=0.6:0.9
says 'both stand' wrong.err '--vary nu=0.6:0.9: the scene stands at both'
absent wrong
limit 1 wrong "$here/slope.inp" --vary nu=0.1:0.3
says 'both fall' wrong.err 'the scene falls at both, one of them should stand'
absent wrong
limit 3 wrong slow.inp --vary push3=3.5:6
says 'no end stands' wrong.err 'at 3.5 neither a solution nor a proof that there is none was found, at 6 it falls'
absent wrong
limit 1 wrong "$here/slope.inp" --vary alpa=0.1:0.3
says 'an unknown parameter' wrong.err 'nearest: alpha'
limit 1 wrong "$here/slope.inp" --vary nu=0.9:0.1
says 'ends the wrong way round' wrong.err 'the first value is not below the second one'
limit 1 wrong "$here/slope.inp" --vary nu=0.1
says 'no range' wrong.err 'NAME=a:b is expected'
limit 1 wrong "$here/slope.inp" --vary nu=0.1:much
says 'no number' wrong.err 'much'
limit 1 wrong "$here/slope.inp" --vary nu=0.1:0.9 --set nu=1
says 'a name twice' wrong.err 'nu is given by --set nu=1'
limit 1 wrong "$here/slope.inp" --vary nu=0.1:0.9 --watch 1000,1
says 'no such node' wrong.err '--watch 1000,1: the deck has no node 1000'
absent wrong
limit 2 wrong "$here/slope.inp" --vary E=0:1
says 'a deck with errors at an end' wrong.err 'E = 0 is not positive'
absent wrong
# a stack over the edge of a table whose nodes stand inside the edges, of the blocks above and, exchanged, of those below: the
# harmonic sum, which no point at a node has; a run finds no solution where the edge would hold, and proves nothing there
stack="$here/../../book/S4-stacks/stack.inp"
sed 's/^B\([1-4]\)-BOTTOM, B\([2-5]\)-TOP/B\2-TOP, B\1-BOTTOM/' "$stack" >exchanged.inp
limit 0 off "$stack" --vary f=0.5:1.2 --set off=0.05
between off 1 1e-6
limit 0 exchanged exchanged.inp --vary f=0.5:1.2 --set off=0.3
between exchanged 1 1e-6
run 3 "$stack" off-run --set off=0.05 --set f=0.99 --quiet
says 'at the edges' off-run/stack.lst 'forces at the ends of masters'
run 4 "$stack" off-run-falls --set off=0.05 --set f=1.01 --quiet
finish
