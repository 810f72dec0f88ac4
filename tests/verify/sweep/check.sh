. "$(dirname "$0")/../lib.sh"
deck=$input/ex1-plate-on-support.inp
# sweep CODE FOLDER [options]
sweep() {
   wanted=$1
   folder=$2
   shift 2
   rm -rf "$folder"
   "$atrito" sweep "$deck" -o "$folder" "$@" >"$folder.out" 2>"$folder.err"
   found=$?
   [ "$found" -eq "$wanted" ] || { complain "sweep $*: exit $found, expected $wanted"; cat "$folder.err"; }
}
# equal_folders WHAT A B: the same tables to the last digit
equal_folders() {
   "$atrito" compare "$2" "$3" --rtol 0 >compare.out 2>&1 || { complain "$1"; cat compare.out; }
}
# count_is WHAT FOLDER NUMBERS: the factorisations of its runs
count_is() {
   found=$(column "$2/runs.tab" factorisations | tr '\n' ' ')
   [ "$found" = "$3 " ] || complain "$1: factorisations $found, expected $3"
}

# Every run is the run of the deck with that value, and the bodies are factored once.
sweep 0 eps --vary eps=1e-5,4e-4,1e-2 --digits 17
for value in 1e-5 4e-4 1e-2; do
   run 0 "$deck" single --set eps=$value --digits 17 --quiet
   equal_folders "eps=$value" single eps/eps_$value
done
count_is 'eps varies' eps '2 0 0'
says 'rows of a sweep' eps/sweep.tab '# columns:                         eps step pair quantity'
near 'a value of a sweep' "$(awk '!/^#/ && $1 == 0.01 && $4 == "normal_resultant" { print $5 }' eps/sweep.tab)" \
   "$(summary eps/eps_1e-2 normal_resultant)" 0
says 'closing lines' eps.out '3 of them solved and checked; 2 factorisations'

# A load is reduced anew, with the factors that are there; a material of one body is factored anew.
sweep 0 q --vary q=1,2 --digits 17
run 0 "$deck" single --set q=2 --digits 17 --quiet
equal_folders 'q=2' single q/q_2
count_is 'q varies' q '2 0'
sed 's/^q = .*/&\nE2 = 1000/; s/^1000., 0.0/<E2>, 0.0/' "$deck" >soft.inp
deck=soft.inp
sweep 0 soft --vary E2=1000,500,500.1 --digits 17
run 0 soft.inp single --set E2=500 --digits 17 --quiet
equal_folders 'E2=500' single soft/E2_500
count_is 'E2 varies' soft '2 1 1'
deck=$input/ex1-plate-on-support.inp

# Workers find the same.
sweep 0 threads --vary eps=1e-5,4e-4,1e-2 --digits 17 --threads 3
for value in 1e-5 4e-4 1e-2; do equal_folders "eps=$value by a worker" eps/eps_$value threads/eps_$value; done
equal_folders 'sweep.tab by workers' eps/sweep.tab threads/sweep.tab
count_is 'workers' threads '2 0 0'

# Several parameters: every combination, the last fastest.
sweep 0 grid --vary nu=0,0.3 --vary 'eps=1e-4, 2*2e-4' --quiet
found=$(column grid/runs.tab folder | tr '\n' ' ')
[ "$found" = 'nu_0,eps_1e-4 nu_0,eps_2_2e-4 nu_0.3,eps_1e-4 nu_0.3,eps_2_2e-4 ' ] || complain "folders of a grid: $found"
same_tables 'a run of the grid' "$here/../../../output/reference/ex1-plate-on-support/contact.tab" \
   grid/nu_0.3,eps_2_2e-4/contact.tab 1e-8
[ -s grid.out ] && complain '--quiet prints'

# A run that fails does not stop the others; the worst code is the sweep's.
sweep 2 broken --vary rho=0.05,-1,0.1 --quiet
absent broken/rho_-1
says 'a failed run is told' broken/sweep.tab '# rho=-1: exit code 2'
found=$(column broken/runs.tab exit | tr '\n' ' ')
[ "$found" = '0 2 0 ' ] || complain "exit codes of runs: $found"
sweep 2 hopeless --vary rho=-1,-2 --quiet
absent hopeless

# Histories: each run to its end is the run by itself; one that ends early has the increments that it wrote, and no part in the screen's
# rows and in pictures; one without any increment has nothing.
"$atrito" sweep "$here/../stability-limit/push.inp" --vary H=2,4,5 -o push --plot --quiet >/dev/null 2>push.err
near 'history that falls: exit code' $? 4 0
run 0 "$here/../stability-limit/push.inp" push-4 --set H=4 --quiet
same_tables 'history' push-4/contact.tab push/H_4/contact.tab 0
read -r first <push/sweep.tab
[ "$first" = '# NOT CONVERGED' ] || complain "push/sweep.tab begins with '$first'"
says 'history that falls' push/sweep.tab '# H=5: exit code 4, its history ends early'
near 'history that falls: quantities' "$(awk '!/^#/ && $1 == 5' push/sweep.tab | wc -l)" "$(grep -vc '^#' push/H_5/summary.tab)" 0
grep -q 'H=4' push/plots/overlay-1.gp || complain 'push/plots/overlay-1.gp has no H=4'
grep -q 'H=5' push/plots/overlay-1.gp && complain 'push/plots/overlay-1.gp has what ends early'
"$atrito" sweep "$here/../stability-limit/push.inp" --vary H=2,4,5 -o push >push.out 2>/dev/null
awk '$1 == 5 { n++; if ($2 != "-" || $5 != "-" || $NF != 4) bad = 1 } END { exit bad || n != 1 }' push.out || complain 'push.out: H = 5'
near 'histories: factored once' "$(column push/runs.tab factorisations | awk '{ n += $1 } END { print n }')" 1 0
sed -e 's/^\*STATIC.*/*STATIC\n0.5, 1, 0.25\n*CONTROLS, METHOD=PICARD, MAXIT=10/' "$here/../no-equilibrium/stack.inp" >slow.inp
"$atrito" sweep slow.inp --vary push3=0.1,3.5 -o slow --quiet >/dev/null 2>&1
near 'history without an increment: exit code' $? 3 0
absent slow/push3_3.5
says 'history without an increment' slow/sweep.tab '# push3=3.5: exit code 3'

# --resume leaves alone what has been made: after a sweep that was killed, with more values, and not with other options.
deck=$input/ex1-plate-on-support.inp
written() { ls -l --time-style=full-iso "$1"/*/summary.tab | awk '{ print $6, $7, $9 }' | sort; }
long=$(awk 'BEGIN { for (i = 1; i <= 30; i++) printf "%s%d.5e-5", (i > 1 ? "," : ""), i }')
sweep 0 whole --vary "eps=$long" --refine 3 --threads 2 --quiet
rm -rf again
"$atrito" sweep "$deck" --vary "eps=$long" --refine 3 --threads 2 -o again --quiet &
job=$!
while kill -0 $job 2>/dev/null; do [ "$(cat again/sweep.journal 2>/dev/null | wc -l)" -ge 3 ] && break; sleep 0.02; done
workers=$(cat /proc/[0-9]*/stat 2>/dev/null | awk -v p="$job" '{ id = $1; sub(/^.*[)] /, "") } $2 == p { print id }')
# shellcheck disable=SC2086
kill -KILL $job $workers 2>/dev/null || complain 'the sweep was over before it could be killed'
wait $job
absent again/runs.tab
made=$(wc -l <again/sweep.journal)
written again >before
for values in "$long" "$long" "$long,1"; do
   "$atrito" sweep "$deck" --vary "eps=$values" --refine 3 --threads 2 -o again --resume >again.out 2>&1 || complain 'sweep --resume'
   says 'runs that are left alone' again.out "left alone   $made run"
   equal_folders "begun again behind $made runs" whole/sweep.tab again/sweep.tab >again.cmp
   grep -q '^FAILED' again.cmp && [ "$values" = "$long" ] && cat again.cmp && failures=$((failures + 1))
   written again >after
   [ "$(comm -12 before after | wc -l)" -ge "$made" ] || complain 'what was made has been made again'
   made=30
   mv after before
done
for folder in whole/eps_*; do equal_folders "$folder begun again" "$folder" "again/${folder#whole/}"; done
near 'one value more' "$(grep -vc '^#' again/runs.tab)" 31 0
"$atrito" sweep "$deck" --vary "eps=1.5e-5,2.5e-5" --refine 2 -o again --resume >again.out 2>&1 || complain 'sweep --resume with another mesh'
grep -q 'left alone' again.out && complain 'another mesh, and runs are left alone'
"$atrito" sweep "$deck" --vary "eps=1.5e-5,2.5e-5,3.5e-5" --refine 3 -o again --resume >again.out 2>&1 || complain 'sweep --resume with the former mesh'
says 'only what is still there' again.out 'left alone   1 run,'
"$atrito" sweep "$deck" --vary "eps=1.5e-5,3.5e-5" --refine 3 -o again >again.out 2>&1 || complain 'sweep without --resume'
grep -q 'left alone' again.out && complain 'without --resume runs are left alone'

# What is wrong with the command line is told before anything is computed.
sweep 1 wrong --vary epss=1,2
says 'an unknown parameter' wrong.err 'setting epss'
absent wrong
sweep 1 wrong --vary eps=1e-4,abc
says 'no number' wrong.err 'abc'
sweep 1 wrong --vary eps=1e-4,1.0e-4
says 'a value twice' wrong.err '1.0e-4 is given twice'
sweep 1 wrong --vary eps=1e-4 --set eps=1
says 'a name twice' wrong.err 'eps is given by --set eps=1'
sweep 1 wrong --vary eps=1e-4 --vary eps=1
says 'a name varied twice' wrong.err 'eps varies already'
sweep 1 wrong
says 'nothing varies' wrong.err 'a sweep needs the parameter that it varies'
sweep 1 wrong --vary eps=1e-4,,1
absent wrong
finish
