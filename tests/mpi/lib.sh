# Shared by the scripts of this folder, which source it with ATRITO-MPI as their first argument: runs by ranks, each of which leaves the
# number of its process in pid.RANK.
. "$(dirname "$0")/../tools/lib.sh"
. "$(dirname "$0")/../../tools/ranks.sh"
atrito_mpi=$1
prepare_mpirun
cd "$work" || exit 9

# by_ranks N WORDS: exit code in `code`, what is said in out and err. Where a run ends with an error mpirun waits two seconds for its
# ranks to end before it kills them; not here, so that what cleans up too late is seen.
by_ranks() {
   n=$1
   shift
   rm -f pid.*
   OMPI_MCA_odls_base_sigkill_timeout=0 mpirun -n "$n" sh -c 'echo $$ >pid.$OMPI_COMM_WORLD_RANK; exec "$0" "$@"' "$atrito_mpi" "$@" >out 2>err
   code=$?
   sed -i '/^\[warn\] Epoll /d' err    # of mpirun's own events, now and then, when a process ends early
}

# begin N WORDS: the same, going on behind; mpirun is process `run`.
begin() {
   n=$1
   shift
   rm -f pid.*
   : >err
   mpirun -n "$n" sh -c 'echo $$ >pid.$OMPI_COMM_WORLD_RANK; exec "$0" "$@"' "$atrito_mpi" "$@" >out 2>err &
   run=$!
}

# await CONDITION: until it holds or the run has ended.
await() {
   while kill -0 "$run" 2>/dev/null; do
      "$@" && return 0
      pause
   done
   return 1
}

# end: waits for mpirun; exit code in `code`.
end() {
   wait "$run"
   code=$?
}

# all_gone WHAT: no rank is left, a moment after mpirun has ended.
all_gone() {
   for file in pid.*; do
      for i in 1 2 3 4 5 6 7 8 9 10; do
         kill -0 "$(cat "$file")" 2>/dev/null || break
         # what has ended and nobody has asked for is gone as well
         grep -q '^State:.*Z' "/proc/$(cat "$file")/status" 2>/dev/null && break
         sleep 0.2 2>/dev/null || sleep 1
      done
      [ "$i" -lt 10 ] || fail "$1: ${file#pid.} goes on"
   done
}

told() { # told FILE TEXT
   grep -q -- "$2" "$1" 2>/dev/null
}

parts() { # parts FOLDER: a temporary file is there
   ls "$1"/*.part >/dev/null 2>&1
}

expect_code() { # expect_code CODE WHAT
   row "$2" "exit $1" "exit $code"
   [ "$code" -eq "$1" ] || { fail "$2: exit $code, expected $1"; cat err; }
}

said_once() { # said_once WHAT TEXT: one error, and it is this one
   [ "$(grep -c 'error \[E-' err)" -eq 1 ] && told err "$2" || { fail "$1: not one message with $2"; cat err; }
   grep -qi 'mpirun\|mpi_abort\|orte\|Backtrace' err && { fail "$1: something else is said, too"; cat err; }
}

nothing_left() { # nothing_left FOLDER WHAT
   [ -z "$(find "$1" -name '*.part' 2>/dev/null)" ] || fail "$2: a temporary file is left"
}

same_files() { # same_files A B WHAT
   diff -rq "$1" "$2" >differences 2>&1 || { fail "$3: files were changed"; cat differences; }
}
