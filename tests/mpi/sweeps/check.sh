#!/bin/sh
# Sweeps and studies over ranks: the tables of the plain program on 1 to 4 ranks, a run that crashes, a rank that is killed, and
# sweeps that are begun again.
#    check.sh MPIRUN ATRITO ATRITO_MPI INPUT
. "$(dirname "$0")/../../tools/lib.sh"
mpirun=$1
plain=$2
over=$3
input=$4
deck=$input/ex1-plate-on-support.inp
OMPI_ALLOW_RUN_AS_ROOT=1
OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
export OMPI_ALLOW_RUN_AS_ROOT OMPI_ALLOW_RUN_AS_ROOT_CONFIRM
cd "$work" || exit 9

# ranks N arguments: exit code in $code, what is said in out and err
ranks() {
   n=$1
   shift
   "$mpirun" --oversubscribe -n "$n" "$over" "$@" >out 2>err
   code=$?
}

expect() { # expect CODE WHAT
   [ "$code" -eq "$1" ] || { fail "$2: exit $code, expected $1"; cat err; }
}

# without_work FILE: runs.tab without how often who factored, which depends on who made which run
without_work() {
   awk '/^# columns:/ { for (i = 3; i <= NF; i++) if ($i == "factorisations") k = i - 2 }
        !/^#/ { $k = "" }
        !/^# (columns|dimensions):/ { print }' "$1"
}

# same_sweep WHAT A B: the same files with the same text, but for times, and for how often who factored
same_sweep() {
   diff -rq -x timing.tab -x '*.lst' -x runs.tab -x sweep.journal "$2" "$3" >differences 2>&1 || { fail "$1: tables differ"; cat differences; }
   without_work "$2/runs.tab" >runs.a
   without_work "$3/runs.tab" >runs.b
   [ -s runs.a ] && cmp -s runs.a runs.b || { fail "$1: runs.tab differs"; diff runs.a runs.b; }
   (cd "$2" && find . -type f | sort) >files.a
   (cd "$3" && find . -type f | sort) >files.b
   cmp -s files.a files.b || { fail "$1: other files"; diff files.a files.b; }
   [ -z "$(find "$3" -name '*.part')" ] || fail "$1: a temporary file is left"
}

# without_times FILE: study.tab without times, and without the remarks that tell some
without_times() {
   awk '/^# columns:/ { for (i = 3; i <= NF; i++) if ($i ~ /_(wall|cpu)$|^(wall|cpu|total|time)/) gone[i - 2] = 1; next }
        /^# dimensions:/ || /^#.* s\)/ { next }
        !/^#/ { for (k in gone) $k = "" }
        { print }' "$1"
}

# ---- the same tables on any number of ranks, whatever becomes of single runs
values=1e-5,2e-5,3e-5,4e-5,5e-5,6e-5,7e-5,8e-5,9e-5,1e-4,2e-4,3e-4,4e-4,5e-4,6e-4,7e-4,8e-4,9e-4,1e-3,2e-3
"$plain" sweep "$deck" --vary "eps=$values" --observe 'tip=u2(1)' --digits 17 -o plain --quiet || fail 'the plain sweep'
"$plain" sweep "$deck" --vary rho=0.05,-1,0.1,0.2 -o broken --quiet >/dev/null 2>&1
for n in 1 2 3 4; do
   ranks $n sweep "$deck" --vary "eps=$values" --observe 'tip=u2(1)' --digits 17 -o "on$n"
   expect 0 "$n ranks"
   same_sweep "$n ranks" plain "on$n"
   ranks $n sweep "$deck" --vary rho=0.05,-1,0.1,0.2 -o "broken$n" --quiet
   expect 2 "$n ranks, a deck with an error"
   same_sweep "$n ranks, a deck with an error" broken "broken$n"
done
ranks 4 sweep "$deck" --vary eps=1e-4,2e-4 -o few
expect 0 'more ranks than runs'
grep -q '^ranks  *4, idle' out || fail 'how ranks were occupied is not told'
ranks 3 sweep "$deck" --vary eps=1e-4,2e-4,3e-4 --threads 2 --plot -o threads --quiet
expect 0 'ranks with threads'

# ---- what is wrong with the command line is told once, and nothing is written
ranks 3 sweep "$deck" --vary epss=1,2,3,4 -o wrong
expect 1 'an unknown parameter'
[ "$(grep -c 'setting epss' err)" -eq 1 ] || { fail 'an unknown parameter: not told once'; cat err; }
ranks 3 sweep "$deck" --vary eps=1e-4,2e-4,3e-4 --observe 'tip=u3(1)' -o wrong
expect 1 'an observation that means nothing'
[ "$(grep -c 'E-OBSERVE' err)" -eq 1 ] || { fail 'a wrong observation: not told once'; cat err; }
[ ! -e wrong ] || fail 'a wrong command line leaves a folder'

# ---- a study
"$plain" study "$deck" --levels 3 --elements cpe4,cpe8 -o study1 --quiet || fail 'the plain study'
without_times study1/study.tab >study.a
for n in 2 4; do
   ranks $n study "$deck" --levels 3 --elements cpe4,cpe8 -o "study$n" --quiet
   expect 0 "a study on $n ranks"
   without_times "study$n/study.tab" >study.b
   [ -s study.a ] && cmp -s study.a study.b || { fail "a study on $n ranks: another table"; diff study.a study.b; }
   diff -rq -x timing.tab -x '*.lst' -x study.tab study1 "study$n" >differences || { fail "a study on $n ranks"; cat differences; }
done

# ---- limits: rank 0 alone, and the tables of the plain program
stability=$input/../tests/verify/stability-limit
# same_limit FOLDER DECK [options]: on 1 to 4 ranks what the plain program finds
same_limit() {
   folder=$1
   shift
   "$plain" limit "$@" --digits 17 -o "$folder" --quiet || fail "the plain limit of $folder"
   for n in 1 2 3 4; do
      ranks $n limit "$@" --digits 17 -o "$folder$n"
      expect 0 "the limit of $folder on $n ranks"
      without_work "$folder/limit.tab" >limit.a
      without_work "$folder$n/limit.tab" >limit.b
      [ -s limit.a ] && cmp -s limit.a limit.b || { fail "the limit of $folder on $n ranks: another table"; diff limit.a limit.b; }
      diff -r -x limit.tab "$folder" "$folder$n" >differences || { fail "the limit of $folder on $n ranks"; cat differences; }
   done
}
same_limit push "$stability/push.inp" --vary H=2:5 --tolerance 0.01
same_limit slope "$stability/slope.inp" --vary nu=0.1:0.9
same_limit arch "$input/lessons/arch.inp" --vary t=.05:.2 --watch 37,2
ranks 3 limit "$stability/slope.inp" --vary nu=0.1:0.9 --refine 3 --threads 2 -o threadslimit --quiet
expect 0 'a limit on 3 ranks with threads'
# what is wrong is told once, also where another rank came upon it
ranks 3 limit "$stability/slope.inp" --vary E=1e6:1e7 -o wrong
expect 1 'a limit that is not between the ends'
ranks 3 limit "$stability/slope.inp" --vary nu=0.1:0.9 --watch 1000,1 -o wrong
expect 1 'a limit that watches no node'
[ "$(grep -c 'has no node 1000' err)" -eq 1 ] || { fail 'a limit that watches no node: not told once'; cat err; }
ranks 3 limit "$stability/slope.inp" --vary E=-1:1 -o wrong
expect 2 'a limit with a deck error at the first end'
[ "$(grep -c 'is not positive' err)" -eq 1 ] || { fail 'a deck error at the first end: not told once'; cat err; }
sed 's/<E>, 0.2/<E>, <poisson>/; s/^nu = 0.7/&\npoisson = 0.2/' "$stability/slope.inp" >poisson.inp
ranks 3 limit poisson.inp --vary poisson=0.2:0.6 -o wrong
expect 2 'a limit with a deck error at the second end'
[ "$(grep -c 'E-.*0.6' err)" -eq 1 ] || { fail 'a deck error at the second end: not told once'; cat err; }
[ ! -e wrong ] || fail 'a limit that went wrong leaves a folder'
sed 's/^\*STEP.*/*STEP, NLGEOM/' "$stability/slope.inp" >told.inp
ranks 3 limit told.inp --vary nu=0.1:0.9 -o told
expect 0 'a limit that has something to tell'
[ "$(grep -c 'warning .W-NLGEOM' err) $(grep -c 'note .N-SMALL' err)" = '1 1' ] || { fail 'a limit: not told once'; cat err; }

long=$(awk 'BEGIN { for (i = 1; i <= 60; i++) printf "%s%d.5e-5", (i > 1 ? "," : ""), i }')
"$plain" sweep "$deck" --vary "eps=$long" --refine 3 -o long --quiet || fail 'the long sweep'
# begin FOLDER: the long sweep by four ranks, mpirun being process $job, until two of its runs are done
begin() {
   rm -rf "$1"
   "$mpirun" --oversubscribe -n 4 "$over" sweep "$deck" --vary "eps=$long" --refine 3 -o "$1" --quiet >out 2>err &
   job=$!
   while kill -0 $job 2>/dev/null; do
      [ "$(cat "$1/sweep.journal" 2>/dev/null | wc -l)" -ge 2 ] && return 0
      pause
   done
   fail "$1: it was over before it could be disturbed"
}
# below PROCESS...: those that they made
below() {
   for p in "$@"; do
      cat /proc/[0-9]*/stat 2>/dev/null | awk -v p="$p" '{ id = $1; sub(/^.*[)] /, "") } $2 == p { print id }'
   done
}
# the processes of the ranks
rank_processes() {
   for p in $(below $job); do grep -q '^atrito' "/proc/$p/comm" && echo "$p"; done 2>/dev/null
}

# lives PROCESS: it has not ended, asked for by whoever made it or not
lives() {
   grep -q '^State:.*[^Z] (' "/proc/$1/status" 2>/dev/null
}

# ---- a run whose process is ended by a fault fails, and nothing else
begin crash
victim=$(below $(rank_processes) | head -1)
kill -SEGV "$victim"
wait $job
code=$?
expect 9 'a run that crashes'
grep -q 'the process of the run eps=' err || { fail 'a run that crashes is not told'; cat err; }
[ "$(awk '!/^#/ && $3 == 9' crash/runs.tab | wc -l)" -eq 1 ] || { fail 'a run that crashes: others failed, too'; cat crash/runs.tab; }
[ "$(awk '!/^#/ && $3 == 0' crash/runs.tab | wc -l)" -eq 59 ] || fail 'a run that crashes: others are missing'
grep -q '^# eps=.*: exit code 9' crash/sweep.tab || fail 'sweep.tab does not tell the run that crashed'
find crash -name summary.tab -exec ls -l --time-style=full-iso {} + | sort >before
ranks 3 sweep "$deck" --vary "eps=$long" --refine 3 -o crash --resume
expect 0 'a sweep begun again after a crash'
same_sweep 'a sweep begun again after a crash' long crash
grep -q 'left alone  *59 runs' out || { fail 'a sweep begun again: how many runs were left alone'; cat out; }
find crash -name summary.tab -exec ls -l --time-style=full-iso {} + | sort >after
[ "$(comm -12 before after | wc -l)" -eq 59 ] || fail 'a sweep begun again touches what was done'

# ---- a rank that is killed: mpirun ends all; what is done stays, and the next sweep goes on
begin killed
victim=$(rank_processes | sed -n 3p)
makers=$(below $(rank_processes))
kill -KILL "$victim"
wait $job
code=$?
[ "$code" -ne 0 ] || fail 'a rank that is killed: exit 0'
for p in $makers; do
   for i in 1 2 3 4 5 6 7 8 9 10; do lives "$p" && sleep 0.5; done
   lives "$p" && fail 'a rank that is killed: a process goes on'
done
[ -z "$(find killed -name '*.part')" ] || fail 'a rank that is killed: half a file is left'
for folder in killed/eps_*; do
   (cd "$folder" && ls) >files.a
   (cd "long/${folder#killed/}" && ls) >files.b
   cmp -s files.a files.b || fail "a rank that is killed: $folder is not whole"
done
ranks 2 sweep "$deck" --vary "eps=$long" --refine 3 -o killed --resume
expect 0 'a sweep begun again after a rank was killed'
grep -q 'left alone ' out || fail 'a sweep begun again after a rank was killed makes all runs anew'
same_sweep 'a sweep begun again after a rank was killed' long killed

# ---- all of it is killed at once
begin all
victims="$job $(below $job) $(below $(rank_processes))"
# shellcheck disable=SC2086
kill -KILL $victims
wait $job
sleep 0.2
ranks 4 sweep "$deck" --vary "eps=$long" --refine 3 -o all --resume
expect 0 'a sweep begun again after all was killed'
grep -q 'left alone ' out || fail 'a sweep begun again after all was killed makes all runs anew'
same_sweep 'a sweep begun again after all was killed' long all
finish
