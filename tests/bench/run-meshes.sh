#!/bin/sh
# Whole runs on meshes of any kind (meshes.py) against one linear solve of the same scene glued together, by MUMPS with AMD and with METIS
# (limit.f90; the program `limit` next to PROGRAM). Prints a table to be pasted; asserts nothing.
#    tests/bench/run-meshes.sh [-n N] [-k KINDS] [-d FOLDER] [-o OPTIONS] [-p PYTHON] [PROGRAM] [SIZE...]
# -n N        repetitions, default 5 (2 of 1e6); in each the run and both orders are measured one after the other, in turns
# -k KINDS    of meshes.py, in one word, default all of them
# -d FOLDER   of the decks: they are made where they are missing, and stay
# -o OPTIONS  further options of the run, in one word: -o '--solver sparse'
# -p PYTHON   with numpy and, for the meshes of Gmsh, gmsh; default python3
# PROGRAM     default: build/release/bin/atrito
# SIZE        about the number of displacements, default 5e4 2e5 1e6
#
# Seconds: processor time of whole processes, user and system, as the system tells it when they have ended; medians. Ratio: run over the
# better of AMD and METIS, the median of neighbours; `solve`: run over the phases of that one from assembly to solve, by its own
# clock (no start of the process, no reading). AMD has the numbering of the fewest operations (limit --count, not measured). MB: peak
# resident memory of the process. One thread.
set -u
top=$(CDPATH="" cd -- "$(dirname -- "$0")/../.." && pwd) || exit 9
kinds='a p a-moved p-moved square hole graded rotated'
repetitions=
options=''
python=python3
work=$(mktemp -d) || exit 9
decks=$work
trap 'rm -rf "$work"' EXIT
trap 'exit 130' INT TERM
usage() {
   sed -n '4,11p' "$0" | sed 's/^# \{0,1\}//' >&2
   exit 1
}
while getopts n:k:d:o:p: option; do
   case $option in
   n) repetitions=$OPTARG ;;
   k) kinds=$OPTARG ;;
   d) decks=$OPTARG ;;
   o) options=$OPTARG ;;
   p) python=$OPTARG ;;
   *) usage ;;
   esac
done
shift $((OPTIND - 1))
case $repetitions in *[!0-9]* | 0) usage ;; esac
program=$top/build/release/bin/atrito
case ${1:-2e5} in
[0-9]*) ;;
*) program=$1 && shift ;;
esac
limit_program=$(dirname "$program")/limit
for file in "$program" "$limit_program"; do
   [ -x "$file" ] || { echo "no program at $file; build it first: cmake --build --preset release (limit needs MUMPS)" >&2; exit 1; }
done
[ $# -gt 0 ] || set -- 5e4 2e5 1e6
mkdir -p "$decks" || exit 1
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1

# measure NAME COMMAND...: $cpu, $memory [MB] and $code of a process; what it said is in $work/NAME.
measure() {
   name=$1
   shift
   measured=$("$python" -c '
import os, sys
with open(sys.argv[1], "wb") as said:
    child = os.posix_spawnp(sys.argv[2], sys.argv[2:], os.environ, file_actions=[(os.POSIX_SPAWN_DUP2, said.fileno(), 1), (os.POSIX_SPAWN_DUP2, said.fileno(), 2)])
    _, status, usage = os.wait4(child, 0)
print("%.6f %.1f %d" % (usage.ru_utime + usage.ru_stime, usage.ru_maxrss*1024e-6, os.waitstatus_to_exitcode(status)))' "$work/$name" "$@") || exit 1
   set -- $measured
   cpu=$1
   memory=$2
   code=$3
}

# measure_limit ORDERING DECK OPTIONS: a row of the file ORDERING: seconds, those of its solve, MB.
measure_limit() {
   ordering=$1
   shift
   measure said "$limit_program" "$@" --ordering "$ordering"
   [ "$code" -eq 0 ] || { echo "limit $*: exit $code" >&2; cat "$work/said" >&2; exit 1; }
   echo "$cpu $(awk '$1 == "total" { print $3 }' "$work/said") $memory" >>"$work/$ordering"
}

measure_run() {
   rm -rf "$work/out"
   # the options are words of their own
   measure said "$program" "$1" $options --threads 1 -o "$work/out" --quiet
   case $code in
   0 | 3) ;;
   *) echo "$1: exit $code" >&2; cat "$work/said" >&2; exit 1 ;;
   esac
   echo "$cpu $cpu $memory $code" >>"$work/run"
}

# median COLUMN: of the rows on the standard input.
median() {
   awk -v k="$1" '{ print $k }' | sort -g | awk '{ t[NR] = $1 } END { m = int((NR + 1)/2); print NR % 2 ? t[m] : (t[m] + t[m + 1])/2 }'
}

# What the tables of the last run say: displacements, points, storages.
facts() {
   awk '
      FILENAME ~ /[.]lst$/ && /free displacements [.]/ { dofs = $NF }
      FILENAME ~ /[.]lst$/ && /^ +body +elements/ { bodies = 1; next }
      FILENAME ~ /[.]lst$/ && bodies { if ($2 !~ /^[0-9]+$/) bodies = 0; else if (!($6 in seen)) { seen[$6] = 1; storage = storage (storage ? "+" : "") $6 } }
      FILENAME ~ /contact[.]tab$/ && !/^#/ { points++ }
      END { print dofs, points + 0, storage }
   ' "$work"/out/*.lst "$work/out/contact.tab"
}

# bench KIND SIZE: a row of the table.
bench() {
   deck=$decks/$1-$2.inp
   if [ ! -s "$deck" ]; then
      "$python" "$top/tests/bench/meshes.py" "$1" "$2" >"$work/deck" || exit 1
      mv "$work/deck" "$deck"
   fi
   n=${repetitions:-5}
   [ -n "$repetitions" ] || [ "$2" != 1e6 ] || n=2
   "$limit_program" "$deck" --count >"$work/counts" 2>&1 || { cat "$work/counts" >&2; exit 1; }
   numbering=$(awk '$1 == "amd" && (!least || $3 + 0 < least) { least = $3 + 0; name = $2 } END { print name }' "$work/counts")
   rm -f "$work/run" "$work/amd" "$work/metis"
   k=0
   while [ $k -lt "$n" ]; do
      case $((k % 3)) in 0) turn='run amd metis' ;; 1) turn='metis run amd' ;; *) turn='amd metis run' ;; esac
      for what in $turn; do
         case $what in
         run) measure_run "$deck" ;;
         amd) measure_limit amd "$deck" --numbering "$numbering" ;;
         metis) measure_limit metis "$deck" ;;
         esac
      done
      k=$((k + 1))
   done
   amd=$(median 1 <"$work/amd")
   metis=$(median 1 <"$work/metis")
   better=$(echo "$amd $metis" | awk '{ print $1 <= $2 ? "amd" : "metis" }')
   paste -d ' ' "$work/run" "$work/$better" | awk '{ print $1/$5, $1/$6 }' >"$work/ratios"
   # a run that did not converge is marked
   mark=$(awk '$4 != 0 { bad = 1 } END { print bad ? "!" : "" }' "$work/run")
   echo "$1 $2 $(facts)" "$(median 1 <"$work/run")" "$amd" "$metis" "$(median 1 <"$work/ratios")" "$(median 2 <"$work/ratios")" \
      "$(median 3 <"$work/run")" "$(median 3 <"$work/amd")" "$(median 3 <"$work/metis")" "$mark" | awk '
      { printf "%-8s %-4s %7d %5d %7.3f %7.3f %7.3f  %5.2f %5.2f  %5.0f %5.0f %5.0f  %s%s\n", $1, $2, $3, $4, $6, $7, $8, $9, $10, $11, $12, $13, $5, $14 }'
}

echo "date: $(date '+%Y-%m-%d %H:%M')"
echo "machine: $(sed -n 's/^model name[^:]*: *//p' /proc/cpuinfo | head -n 1), $(getconf _NPROCESSORS_ONLN) cores," \
   "$(awk '/^MemTotal/ { printf "%.0f GB", $2/1e6 }' /proc/meminfo), $(uname -sr), load $(cut -d ' ' -f 1 /proc/loadavg)"
"$program" --version | sed 's/^atrito/program: atrito/'
[ -z "$options" ] || echo "options of the run: $options"
echo "repetitions: ${repetitions:-5, 2 of 1e6}; run, AMD and METIS in turn; whole processes, user and system; medians"
echo
printf '%-8s %-4s %7s %5s %7s %7s %7s  %11s  %17s\n' '' '' '' '' run AMD METIS 'ratio to the' 'peak, MB'
printf '%-8s %-4s %7s %5s %7s %7s %7s  %5s %5s  %5s %5s %5s  %s\n' kind size dofs pts 'CPU s' 'CPU s' 'CPU s' proc. solve run AMD METIS storage
for size; do
   for kind in $kinds; do bench "$kind" "$size"; done
done
