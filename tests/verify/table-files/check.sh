#!/bin/sh
# Tables with a head and as comma-separated values: the same numbers, read by other programs.
. "$(dirname "$0")/../lib.sh"
deck=$input/lessons/press-and-push.inp
run 0 "$deck" tab --quiet
run 0 "$deck" csv --format csv
says 'the screen' csv.out 'contact summary extremes'
for table in contact summary history iterations; do
   [ -s "csv/$table.csv" ] || complain "csv/$table.csv is missing"
   absent "csv/$table.tab"
   # the rows with a head, blanks as commas, and the names before them
   { sed -n 's/^# columns: *//p' "tab/$table.tab"; grep -v '^#' "tab/$table.tab"; } |
      sed 's/^ *//; s/  */,/g; s/\(^\|,\)nan\(,\|$\)/\1NaN\2/g; s/$/\r/' >"$table.expected"
   cmp "$table.expected" "csv/$table.csv" || complain "$table.csv: other text"
done
"$atrito" compare tab csv --rtol 0 >compare.out || { complain 'the forms differ'; cat compare.out; }
sed 's/,1\r$/,2\r/' csv/contact.csv >changed.csv
"$atrito" compare tab/contact.tab changed.csv >compare.out && complain 'changed values are the same'
says 'compare' compare.out 'increment: 1 / 2'

# heads beside comma-separated values; what the heads say is told first, and rules by table and column
sed -n '/^#/p' tab/contact.tab >head.expected
cmp head.expected csv/contact.head || complain 'contact.head'
one=$input/ex1-plate-on-support.inp
run 0 "$one" first --quiet
run 0 "$one" second --quiet --set nu=0.31 --digits 12 --format csv
"$atrito" compare first second >compare.out && complain 'another friction is the same'
[ "$(head -1 compare.out)" = 'other parameters: nu = 0.3 / nu = 0.31 (--set)' ] || complain 'the heads are not told first'
says 'options' compare.out 'other options: none / --digits 12'
compared() { wanted=$1; shift; "$atrito" compare first second "$@" >compare.out 2>compare.err; [ $? -eq "$wanted" ] || { complain "$*"; cat compare.out; }; }
printf '# coarse\ncontact * 1e-9\n* * 0.2\ncontact status 0  # equal\n' >rules
compared 0 --tables contact --tolerances rules
printf 'contact pressure 1e-9\n' >>rules
compared 1 --tables contact --tolerances rules
[ "$(grep -c 'pressure: ' compare.out)" -eq "$(grep -c '^contact' compare.out)" ] || complain 'other columns than that of the rule'
compared 0 --tables contact --tolerances rules --ignore contact.pressure
printf 'contact presure 1e-9\n' >>rules
compared 1 --tables contact --tolerances rules --ignore contact.pressure
says 'a column that is not there' compare.out 'there is no presure'
compared 1 --ignore contct
says 'a table that is not there' compare.err 'nearest: contact'
printf 'contact pressure\n' >rules
compared 5 --tolerances rules
says 'no rule' compare.err 'rules, line 1 is no rule'
compared 1 --tables summary --messages json
says 'json' compare.err '"id":"E-DIFFERENT"'

# other programs
if command -v python3 >/dev/null; then
   python3 "$here/read.py" tab csv 2>python.err >python.out || { complain 'python'; cat python.err; }
   cat python.out
fi
if command -v gnuplot >/dev/null; then
   cat >stats.gp <<'END'
stats "tab/contact.tab" using 8 nooutput; print STATS_sum, STATS_records
set datafile separator comma
stats "csv/contact.csv" using 8 nooutput; print STATS_sum, STATS_records
stats "csv/contact.csv" using "pressure" nooutput; print STATS_sum, STATS_records
END
   gnuplot stats.gp 2>gnuplot.out
   [ "$(sort -u gnuplot.out | wc -l)" -eq 1 ] && [ "$(wc -l <gnuplot.out)" -eq 3 ] || { complain 'gnuplot'; cat gnuplot.out; }
fi
# one form at a time, of every command; what another command has written stays
"$atrito" "$deck" -o csv --quiet || complain 'the run with heads fails'
ls csv/*.csv >left 2>/dev/null && complain "csv files are left: $(cat left)"
one=$input/ex1-plate-on-support.inp
"$atrito" sweep "$one" --vary nu=0,0.3 --vary q=1 --format csv --quiet -o all || complain 'the sweep fails'
printf 'run,nu,q,exit,factorisations,folder\r\n1,0,1.000000000e+00,0,2,"nu_0,q_1"\r\n2,3.000000000e-01,1.000000000e+00,0,0,"nu_0.3,q_1"\r\n' >expected
cmp expected all/runs.csv || complain 'runs.csv'
[ -s all/sweep.csv ] && [ -s all/nu_0,q_1/contact.csv ] || complain 'a sweep without csv'
"$atrito" study "$one" --levels 1 --format csv --quiet -o all || complain 'the study fails'
[ -s all/study.csv ] && [ -s all/sweep.csv ] && [ -s all/deck_0/summary.csv ] || complain 'a study without csv'
"$atrito" "$one" -o all --quiet || complain 'the run fails'
[ -s all/contact.tab ] && [ -s all/study.csv ] && [ -s all/sweep.csv ] || complain 'a run removes the tables of others'
"$atrito" sweep "$one" --vary nu=0,0.3 --quiet -o all || complain 'the second sweep fails'
[ -s all/sweep.tab ] && [ -s all/contact.tab ] && [ ! -e all/sweep.csv ] && [ ! -e all/runs.csv ] || complain 'tables of both forms are left'

# default folders
rm -rf output
"$atrito" sweep "$one" --vary nu=0 --quiet && "$atrito" study "$one" --levels 1 --quiet && "$atrito" "$one" --quiet || complain 'default folders'
[ -s output/ex1-plate-on-support/contact.tab ] && [ -s output/ex1-plate-on-support-sweep/sweep.tab ] &&
   [ -s output/ex1-plate-on-support-study/study.tab ] && [ "$(find output -mindepth 1 -maxdepth 1 | wc -l)" -eq 3 ] || complain 'other folders'

finish
