#!/bin/sh
# Runs that are ended from outside: the exit code of the signal, no half file, older results untouched, children gone.
#    interrupts.sh ATRITO PROBE DECK
# Nothing is decided by how long something takes: a signal is sent when the run shows that it is where it is wanted, and a run that
# was over before the signal came is made again on a larger mesh.
. "$(dirname "$0")/lib.sh"
atrito=$1
probe=$2
deck=$3
cd "$work" || exit 9

# await PROCESS CONDITION: until the condition holds or the process has ended
await() {
   process=$1
   shift
   while kill -0 "$process" 2>/dev/null; do
      "$@" && return 0
      pause
   done
   return 1
}

parts() { # parts FOLDER: a temporary file is there
   ls "$1"/*.part >/dev/null 2>&1
}

told() { # told FILE TEXT
   grep -q -- "$2" "$1" 2>/dev/null
}

expect_code() { # expect_code CODE WHAT: $code is CODE
   row "$2" "exit $1" "exit $code"
   [ "$code" -eq "$1" ] || { fail "$2: exit $code, expected $1"; cat err; }
}

no_parts() { # no_parts FOLDER WHAT
   [ -z "$(find "$1" -name '*.part' 2>/dev/null)" ] || fail "$2: a temporary file is left"
}

same_files() { # same_files A B WHAT: two folders hold the same
   diff -rq "$1" "$2" >differences 2>&1 || { fail "$3: files were changed"; cat differences; }
}

# --- the probe: what a run does only by chance -----------------------------------------------------------------------------------
fresh() { # fresh: a folder with results
   rm -rf old
   mkdir old
   echo old >old/a
   echo old >old/b
}
for mode in at-once fault overflow exit; do
   fresh
   cp -r old before
   "$probe" $mode old >out 2>err
   code=$?
   case $mode in
      at-once) expect_code 143 "a signal at a moment of its own ($mode)" ;;
      exit) expect_code 1 "an end by the run-time library ($mode)" ;;
      *) expect_code 9 "an internal fault ($mode)"; told err 'E-INTERNAL' || fail "$mode: not told" ;;
   esac
   same_files before old "probe $mode"
   "$probe" $mode new/er >out 2>err
   [ ! -e new ] || fail "probe $mode: new folders are left"
   rm -rf before
done
for mode in put-off commit; do
   fresh
   "$probe" $mode old >out 2>err
   code=$?
   expect_code 143 "a signal while files are renamed ($mode)"
   [ "$(cat old/a old/b)" = 'new
new' ] || fail "probe $mode: not all files are new"
   no_parts old "probe $mode"
   rm -rf new
   "$probe" $mode new/er >out 2>err
   [ -f new/er/b ] || fail "probe $mode: the new folder is gone"
done
rm -rf old new

# --- decks: one that takes long to factor, one that takes long to write ----------------------------------------------------------
strip() { # strip N: a strip of N elements, cheap to solve
   printf '%s\n' '*PARAMETER' 'q = 1' "*BLOCK, TYPE=CPE4, ELSET=B, NX=2, NY=$1" '0, 0' '2, 0' "2, $1" "0, $1" \
      '*MATERIAL, NAME=M' '*ELASTIC' '1, 0.3' '*SOLID SECTION, ELSET=B, MATERIAL=M' '*BOUNDARY' 'B-LEFT, 1, 2' '*STEP' '*STATIC' \
      '*DSLOAD' 'B-RIGHT, P, <q>' '*NODE PRINT' 'U, RF' '*EL PRINT' 'S' '*END STEP' >strip.inp
}
strip 20
"$atrito" strip.inp -o first --quiet || fail 'the deck itself fails'

# --- in the factorisation ---------------------------------------------------------------------------------------------------------
factor() { # factor SIGNAL CODE FOLDER
   for level in 5 6; do
      : >err
      "$atrito" "$deck" --refine $level -o "$3" --progress all 2>err >out &
      run=$!
      await $run told err '^factor '
      kill -"$1" $run 2>/dev/null
      wait $run
      code=$?
      [ $code -eq 0 ] || break
   done
   expect_code "$2" "SIG$1 in the factorisation"
   told err 'E-INTERRUPTED' || fail "SIG$1: not told"
   told err 'rror termination\|Backtrace' && fail "SIG$1: the run-time library complains"
}
cp -r first kept
factor TERM 143 kept
same_files first kept 'SIGTERM in the factorisation'
factor HUP 129 some/where/new
[ ! -e some ] || fail 'SIGHUP in the factorisation: a folder was made'


# every signal that ends a program and can be caught: no file is left, and the code is that of the signal
for signal in QUIT ALRM USR1 USR2 ABRT XCPU VTALRM PROF PWR IO STKFLT TRAP SYS SEGV BUS FPE ILL RTMIN RTMAX; do
   number=$(kill -l $signal 2>/dev/null) || continue
   : >err
   rm -rf drawn
   "$atrito" "$deck" --refine 6 -o drawn/new --progress all 2>err >out &
   run=$!
   await $run told err '^factor '
   kill -$signal $run 2>/dev/null
   wait $run 2>/dev/null
   code=$?
   [ $code -eq $((128 + number)) ] || fail "SIG$signal: exit $code"
   told err 'E-INTERRUPTED' || { fail "SIG$signal: not told"; cat err; }
   [ ! -e drawn ] || fail "SIG$signal: something is left"
done

# --- while the tables are written -------------------------------------------------------------------------------------------------
writing() { # writing FOLDER WATCHED
   for n in 20000 80000 320000; do
      strip $n
      "$atrito" strip.inp -o "$1" --quiet --digits 17 2>err >out &
      run=$!
      await $run parts "$1"
      kill -TERM $run 2>/dev/null
      wait $run
      code=$?
      [ $code -eq 0 ] || break
      rm -rf "$1"
      [ "$1" = kept ] && cp -r first kept
   done
   expect_code 143 "SIGTERM while writing into $1"
}
writing kept
same_files first kept 'SIGTERM while writing'
writing some/where/new

# --- the output folder is removed under the run -----------------------------------------------------------------------------------
for n in 20000 80000 320000; do
   strip $n
   "$atrito" strip.inp -o gone --quiet --digits 17 2>err >out &
   run=$!
   await $run parts gone
   rm -rf gone
   wait $run
   code=$?
   [ $code -eq 0 ] || break
done
expect_code 5 'the output folder removed while the tables are written'
told err 'gone/' || fail 'the output folder removed: no file is named'
[ ! -e gone ] || fail 'the output folder removed: something is left'
[ ! -e some ] || fail 'SIGTERM while writing: the new folders are left'

# SIGKILL leaves temporary files, which the next run removes, whether or not it writes these tables
for n in 20000 80000 320000; do
   strip $n
   "$atrito" strip.inp -o killed --quiet --digits 17 2>err >out &
   run=$!
   await $run test -e killed/stress.tab.part
   kill -KILL $run 2>/dev/null
   wait $run 2>/dev/null
   parts killed && break
   rm -rf killed
done
parts killed || fail 'SIGKILL while writing: no temporary file was seen'
strip 20
sed -i.bak '/^\*EL PRINT/,/^S$/d' strip.inp
"$atrito" strip.inp -o killed --quiet || fail "after SIGKILL: exit $?"
no_parts killed 'after SIGKILL'
[ -f killed/nodes.tab ] && [ ! -e killed/stress.tab ] || fail 'after SIGKILL: not the tables of the new run'

# SIGINT: a job in the background of a script ignores it, so the run stands in the foreground and the signal comes from behind
strip 20000
: >err
(
   until [ -s id ]; do pause; done
   await "$(cat id)" parts kept
   kill -INT "$(cat id)"
) &
sh -c 'echo $$ >id; exec "$0" "$@"' "$atrito" strip.inp -o kept --quiet --digits 17 2>err
code=$?
wait
[ $code -eq 0 ] && { rm -rf kept; cp -r first kept; } || { expect_code 130 SIGINT; same_files first kept SIGINT; }

# ignored at the start, it stays ignored
strip 2000
: >err
"$atrito" strip.inp -o ignored --progress all 2>err >out &   # a job in the background: SIGINT is ignored
run=$!
await $run told err '^body '
kill -INT $run 2>/dev/null
wait $run
code=$?
expect_code 0 'an ignored SIGINT'
[ -f ignored/nodes.tab ] || fail 'an ignored SIGINT: no tables'

# --- a sweep ------------------------------------------------------------------------------------------------------------------------
# worker N: a worker writes its run N
for threads in 1 3; do
   for n in 20000 80000 320000; do
      strip $n
      rm -rf sweep
      "$atrito" sweep strip.inp -o sweep --threads $threads --quiet --vary q=1,2,3,4,5,6,7 2>err >out &
      run=$!
      await $run parts sweep/q_3
      kill -TERM $run 2>/dev/null
      wait $run
      code=$?
      [ $code -eq 0 ] || break
   done
   expect_code 143 "a sweep, --threads $threads"
   [ "$(grep -c E-INTERRUPTED err)" -eq 1 ] || fail "a sweep, --threads $threads: told more than once, or not at all"
   [ -f sweep/q_1/summary.tab ] || fail "a sweep, --threads $threads: a finished run is gone"
   no_parts sweep "a sweep, --threads $threads"
   for folder in sweep/q_*; do
      [ -f "$folder/summary.tab" ] || fail "a sweep, --threads $threads: $folder is left without tables"
   done
   [ ! -e sweep/sweep.tab ] || fail "a sweep, --threads $threads: sweep.tab was written"
   find sweep -type f -exec cksum {} + | sort >sums
   # no worker goes on: flock waits for the last process that has the folder, and nothing has changed then
   if command -v flock >/dev/null; then
      flock sweep true
      find sweep -type f -exec cksum {} + | sort | cmp -s - sums || fail "a sweep, --threads $threads: a worker went on"
   fi
done

# an older sweep.tab stays as it was
strip 20
"$atrito" sweep strip.inp -o sweep --quiet --vary q=1,2,3,4,5,6,7 || fail 'the sweep itself fails'
cp sweep/sweep.tab sweep.tab
strip 80000
"$atrito" sweep strip.inp -o sweep --quiet --vary q=1,2,3,4,5,6,7 2>err >out &
run=$!
await $run parts sweep/q_2
kill -TERM $run 2>/dev/null
wait $run
code=$?
[ $code -eq 0 ] || cmp -s sweep/sweep.tab sweep.tab || fail 'an interrupted sweep: sweep.tab is not the old one'

# --- while pictures are drawn: a stand-in for gnuplot that never ends ---------------------------------------------------------------
mkdir bin
cat >bin/gnuplot <<'END'
#!/bin/sh
echo half >mesh.png
echo complaint
sleep 100000
END
chmod +x bin/gnuplot
strip 20
PATH=$work/bin:$PATH "$atrito" strip.inp -o drawn --plot 2>err >out &
run=$!
await $run [ -s drawn/plots/mesh.png ]
kill -TERM $run
wait $run
code=$?
expect_code 143 'while drawing'
[ -f drawn/nodes.tab ] || fail 'while drawing: the tables are gone'
[ -f drawn/plots/mesh.gp ] || fail 'while drawing: the scripts are gone'
[ ! -e drawn/plots/mesh.png ] || fail 'while drawing: half a picture is left'
[ ! -e drawn/plots/gnuplot.log ] || fail 'while drawing: the log is left'
if command -v flock >/dev/null; then
   flock -n drawn true || fail 'while drawing: gnuplot goes on'
fi

# SIGKILL while drawing: gnuplot and what it has started go, too, and nothing keeps the next run
PATH=$work/bin:$PATH "$atrito" strip.inp -o drawn --plot 2>err >out &
run=$!
await $run [ -s drawn/plots/mesh.png ]
kill -KILL $run
wait $run 2>/dev/null
i=0
while [ $i -lt 250 ] && ps -e -o args= 2>/dev/null | grep -q '^sleep 100000$'; do
   i=$((i + 1))
   pause
done
[ $i -lt 250 ] || fail 'SIGKILL while drawing: gnuplot draws on'
timeout 60 "$atrito" strip.inp -o drawn --quiet || fail "SIGKILL while drawing: the next run ends with $?"
[ ! -e drawn/.atrito.lock ] || fail 'SIGKILL while drawing: the lock is left'

# SIGKILL of a sweep: its workers go, too
strip 80000
"$atrito" sweep strip.inp -o workers --threads 3 --quiet --vary q=1,2,3,4,5,6,7 2>err >out &
run=$!
await $run parts workers/q_3
kill -KILL $run
wait $run 2>/dev/null
i=0
while [ $i -lt 250 ] && ps -e -o args= 2>/dev/null | grep -q '^[^ ]*atrito sweep strip.inp -o workers'; do
   i=$((i + 1))
   pause
done
[ $i -lt 250 ] || fail 'SIGKILL of a sweep: a worker goes on'

finish
