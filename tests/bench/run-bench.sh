#!/bin/sh
# The bench: whole runs of scenes A and P and of example 3 against the limit, one linear solve of the same scene glued together by
# MUMPS (limit.f90; the program `limit` next to PROGRAM). Prints a table to be pasted; asserts nothing.
#    tests/bench/run-bench.sh [-n N] [-t] [-b SECONDS] [-o OPTIONS] [PROGRAM] [SIZE...]
# -n N        repetitions, default 5; in each the limit and the run are measured one after the other, and their ratio is taken
# -t          two more tables: wall seconds with 1, 2 and 4 threads (the limit always takes one), and how much faster several are
# -b SECONDS  what takes less processor time is repeated until it has taken so long, default 0.5; the mean counts
# -o OPTIONS  further options of the run, in one word: -o '--solver skyline'
# PROGRAM     default: build/release/bin/atrito
# SIZE        2e3 1e4 5e4 2e5 1e6: displacements of scenes A and P; r0 .. r5: example 3 with --refine 0 .. 5. Default: all
#
# Run: processor seconds of the whole process, from its start to its end, as the shell counts them (`times`, user and system):
# loading the libraries, reading the deck, all tables into a new folder, giving the memory back. (The total of timing.tab is the sum
# of its phases and less than that.) Limit: assembly, order, analysis, factorisation and solve, by the clock of the limit program;
# nothing else of that process. Of AMD with the cheapest numbering and METIS the better one is taken. Wall seconds in the same way, those
# of the run by /proc/uptime.
set -u
top=$(CDPATH="" cd -- "$(dirname -- "$0")/../.." && pwd) || exit 9
repetitions=5
least=0.5
threads=no
options=''
usage() {
   sed -n '4,10p' "$0" | sed 's/^# \{0,1\}//' >&2
   exit 1
}
while getopts n:tb:o: option; do
   case $option in
   n) repetitions=$OPTARG ;;
   t) threads=yes ;;
   b) least=$OPTARG ;;
   o) options=$OPTARG ;;
   *) usage ;;
   esac
done
shift $((OPTIND - 1))
case $repetitions in '' | *[!0-9]* | 0) usage ;; esac
program=$top/build/release/bin/atrito
case ${1:-2e3} in
2e3 | 1e4 | 5e4 | 2e5 | 1e6 | r[0-5]) ;;
*) program=$1 && shift ;;
esac
[ -x "$program" ] || { echo "no program at $program; build it first: cmake --build --preset release" >&2; exit 1; }
limit_program=$(dirname "$program")/limit
[ -x "$limit_program" ] || { echo "no limit program at $limit_program; it needs MUMPS (libmumps-seq-dev) when atrito is built" >&2; exit 1; }
[ $# -gt 0 ] || set -- 2e3 1e4 5e4 2e5 1e6 r0 r1 r2 r3 r4 r5
work=$(mktemp -d) || exit 9
trap 'rm -rf "$work"' EXIT
trap 'exit 130' INT TERM

# Scene, size and deck of a size, a line each: `A 2e3 DECK [OPTIONS]`.
scenes_of() {
   case $1 in
   2e3) set -- "$1" 2 20 ;;
   1e4) set -- "$1" 5 44 ;;
   5e4) set -- "$1" 11 100 ;;
   2e5) set -- "$1" 21 200 ;;
   1e6) set -- "$1" 47 446 ;;
   r[0-5]) echo "ex3 $1 $top/input/ex3-pillar-in-ground.inp --refine ${1#r}" && return ;;
   *) echo "there is no size $1" >&2 && return 1 ;;
   esac
   sh "$top/tests/bench/scene-a.sh" "$2" >"$work/a-$1.inp" && echo "A $1 $work/a-$1.inp"
   sh "$top/tests/bench/scene-p.sh" "$3" >"$work/p-$1.inp" && echo "P $1 $work/p-$1.inp"
}

failed() {
   echo "$*: exit $code" >&2
   cat "$work/said" >&2
   exit 1
}

# measure_limit DECK ARGUMENTS: $wall and $cpu of the limit in the order of $how, the mean of $batch of them.
measure_limit() {
   i=0
   : >"$work/limits"
   while [ $i -lt "$batch" ]; do
      # the order is two words or four
      "$limit_program" "$@" $how >"$work/limit" 2>"$work/said" || { code=$?; failed limit "$@" $how; }
      cat "$work/limit" >>"$work/limits"
      i=$((i + 1))
   done
   wall=$(awk '$1 == "total" { s += $2; n++ } END { printf "%.6f", s/n }' "$work/limits")
   cpu=$(awk '$1 == "total" { s += $3; n++ } END { printf "%.6f", s/n }' "$work/limits")
}

# choose_limit DECK ARGUMENTS: $how, the better order, tried once each.
choose_limit() {
   "$limit_program" "$@" --count >"$work/counts" 2>"$work/said" || { code=$?; failed limit "$@" --count; }
   how="--ordering amd --numbering $(awk '$1 == "amd" && (!least || $3 + 0 < least) { least = $3 + 0; name = $2 } END { print name }' "$work/counts")"
   grep -q '^metis' "$work/counts" || return 0
   measure_limit "$@"
   amd="$cpu $how"
   how='--ordering metis'
   measure_limit "$@"
   how=$(printf '%s\n' "$amd" "$cpu $how" | sort -g | sed -n '1s/^[^ ]* //p')
}

# measure_run THREADS DECK ARGUMENTS: $wall and $cpu of the run, the mean of $batch of them.
measure_run() {
   n_threads=$1
   shift
   i=0
   rm -rf "$work"/out.*
   read -r begun rest </proc/uptime
   times >"$work/before"
   while [ $i -lt "$batch" ]; do
      # the options are words of their own
      "$program" "$@" $options --threads "$n_threads" -o "$work/out.$i" --quiet >/dev/null 2>"$work/said" || { code=$?; failed "$@"; }
      i=$((i + 1))
   done
   times >"$work/after"
   read -r ended rest </proc/uptime
   wall=$(awk -v a="$begun" -v b="$ended" -v n="$batch" 'BEGIN { printf "%.6f", (b - a)/n }')
   # the second line is of the children: 0m0.120000s 0m0.030000s
   cpu=$(cat "$work/before" "$work/after" | awk -v n="$batch" '
      NR % 2 == 0 { split($0, w, /[ms ]+/); t = 60*w[1] + w[2] + 60*w[3] + w[4]; sum += NR == 4 ? t : -t }
      END { printf "%.6f", sum/n }')
}

# Least, median and greatest of the numbers on the standard input.
spread() {
   sort -g | awk '{ t[NR] = $1 } END { m = int((NR + 1)/2); printf "%s %s %s\n", t[1], NR % 2 ? t[m] : (t[m] + t[m + 1])/2, t[NR] }'
}

# Three numbers, each in at most five characters up to 99999: those of 100 and more, as on a busy machine, without decimals.
narrow() {
   awk '{ for (i = 1; i <= 3; i++) printf ($i < 99.995 ? "%.2f " : "%.0f "), $i; print "" }'
}
median() {
   spread | cut -d ' ' -f 2
}

# How often a run has to be repeated: $batch.
find_batch() {
   batch=1
   measure_run 1 "$@"
   batch=$(awk -v t="$cpu" -v least="$least" 'BEGIN { n = (t > 0.01) ? least/t : 100*least; n = int(n + 0.999); print n < 1 ? 1 : n }')
}

# What the tables of the last run say: displacements, points, megabytes, outer iterations, linear solves, storages.
facts() {
   awk '
      FILENAME ~ /[.]lst$/ && /free displacements [.]/ { dofs = $NF }
      FILENAME ~ /[.]lst$/ && /^ +body +elements/ { bodies = 1; next }
      FILENAME ~ /[.]lst$/ && bodies { if ($2 !~ /^[0-9]+$/) bodies = 0; else if (!($6 in seen)) { seen[$6] = 1; storage = storage (storage ? "+" : "") $6 } }
      FILENAME ~ /contact[.]tab$/ && !/^#/ { points++ }
      FILENAME ~ /timing[.]tab$/ && /^# peak memory/ { memory = $NF/1e6 }
      FILENAME ~ /summary[.]tab$/ && $3 == "picard_iterations" { outer = $4 }
      FILENAME ~ /summary[.]tab$/ && $3 == "linear_solves" { solves = $4 }
      END { print dofs, points + 0, memory, outer, solves, storage }
   ' "$work"/out.0/*.lst "$work/out.0/contact.tab" "$work/out.0/timing.tab" "$work/out.0/summary.tab"
}

# bench_cpu SCENE SIZE DECK [ARGUMENTS]: a row of the first table.
bench_cpu() {
   scene=$1
   size=$2
   shift 2
   find_batch "$@"
   choose_limit "$@"
   : >"$work/rows"
   k=0
   while [ $k -lt "$repetitions" ]; do
      measure_limit "$@"
      limit=$cpu
      measure_run 1 "$@"
      echo "$limit $cpu" >>"$work/rows"
      k=$((k + 1))
   done
   limit=$(cut -d ' ' -f 1 "$work/rows" | median)
   run=$(cut -d ' ' -f 2 "$work/rows" | median)
   ratios=$(awk '{ print $2/$1 }' "$work/rows" | spread | narrow)
   echo "$scene $size $limit $run $ratios $(facts)" | awk '
      { printf "%-8s %7d %6d %8.4f %8.4f  %5s %5s %5s %5.0f %5d %6d  %s\n", $1 " " $2, $8, $9, $3, $4, $5, $6, $7, $10, $11, $12, $13 }'
   echo "$scene $size $run $(facts)" >>"$work/results"
}

# bench_threads SCENE SIZE DECK [ARGUMENTS]: a row of the second table.
bench_threads() {
   scene=$1
   size=$2
   shift 2
   find_batch "$@"
   choose_limit "$@"
   : >"$work/rows"
   k=0
   while [ $k -lt "$repetitions" ]; do
      measure_limit "$@"
      row=$wall
      # in turns: what runs just after the limit, which gave much memory back, is a little faster
      case $((k % 3)) in 0) turn='1 2 4' ;; 1) turn='4 1 2' ;; *) turn='2 4 1' ;; esac
      for t in $turn; do
         measure_run "$t" "$@"
         eval "wall_$t=\$wall"
      done
      # shellcheck disable=SC2154
      echo "$row $wall_1 $wall_2 $wall_4" >>"$work/rows"
      k=$((k + 1))
   done
   row=$(printf '%-8s %7.4f ' "$scene $size" "$(cut -d ' ' -f 1 "$work/rows" | median)")
   for t in 2 3 4; do row=$row$(printf ' %7.4f' "$(cut -d ' ' -f $t "$work/rows" | median)"); done
   for t in 2 3 4; do row=$row$(awk -v t=$t '{ print $t/$1 }' "$work/rows" | spread | narrow | awk '{ printf "  %5s %5s %5s", $1, $2, $3 }'); done
   echo "$row"
   awk '{ print $2/$3 }' "$work/rows" | spread | narrow >"$work/two"
   awk '{ print $2/$4 }' "$work/rows" | spread | narrow >"$work/four"
   echo "$scene $size $(cat "$work/two") $(cat "$work/four")" >>"$work/speedups"
}

# The exponent of the growth of the run time from 2e5 to 1e6 displacements.
print_growth() {
   for scene in A P; do
      awk -v scene="$scene" '
         $1 == scene && $2 == "2e5" { n1 = $4; t1 = $3 }
         $1 == scene && $2 == "1e6" { n2 = $4; t2 = $3 }
         END { if (n1 && n2) printf "growth of the run from 2e5 to 1e6, scene %s: dofs^%.2f\n", scene, log(t2/t1)/log(n2/n1) }
      ' "$work/results"
   done
}

print_head() {
   echo "date: $(date '+%Y-%m-%d %H:%M')"
   echo "machine: $(sed -n 's/^model name[^:]*: *//p' /proc/cpuinfo | head -n 1), $(getconf _NPROCESSORS_ONLN) cores," \
      "$(awk '/^MemTotal/ { printf "%.0f GB", $2/1e6 }' /proc/meminfo), $(uname -sr)"
   echo "load at the beginning: $(cut -d ' ' -f 1 /proc/loadavg)"
   "$program" --version | sed 's/^atrito/program: atrito/'
   [ -z "$options" ] || echo "options of the run: $options"
   echo "repetitions: $repetitions, limit and run in turn; medians; ratio: least, median, greatest"
   echo "run: whole process, user and system, by the shell's times"
   echo "limit: the better of AMD and METIS, its phases from assembly to solve"
   echo
}

for size; do scenes_of "$size" || exit 1; done >"$work/scenes" || exit 1
: >"$work/results"
print_head
printf '%-8s %7s %6s %8s %8s  %17s %5s %5s %6s  %s\n' '' '' contact limit run 'ratio' peak '' '' ''
printf '%-8s %7s %6s %8s %8s  %5s %5s %5s %5s %5s %6s  %s\n' scene dofs points 'CPU s' 'CPU s' least med. most MB outer solves storage
while read -r line; do bench_cpu $line || exit 1; done <"$work/scenes"
print_growth
[ $threads = yes ] || exit 0
echo
echo 'wall seconds; the limit takes one thread'
printf '%-8s %7s  %23s  %17s  %17s  %17s\n' '' '' 'run, threads' 'ratio, 1 thread' 'ratio, 2 threads' 'ratio, 4 threads'
printf '%-8s %7s  %7s %7s %7s  %17s  %17s  %17s\n' scene limit 1 2 4 'least  med.  most' 'least  med.  most' 'least  med.  most'
while read -r line; do bench_threads $line || exit 1; done <"$work/scenes"
echo
echo 'one thread over several, neighbours'
printf '%-8s %19s  %17s\n' '' '2 threads' '4 threads'
printf '%-8s %19s  %17s\n' scene 'least  med.  most' 'least  med.  most'
awk '{ printf "%-8s   %5s %5s %5s  %5s %5s %5s\n", $1 " " $2, $3, $4, $5, $6, $7, $8 }' "$work/speedups"
