#!/bin/sh
# ./run --ranks N: what it installs and builds, how mpirun is called, the exit codes, signals. mpirun, apt-get, cmake and the program
# are stand-ins; tests/mpi has the true ones.
#    run_ranks.sh SOURCES
. "$(dirname "$0")/lib.sh"
sources=$1
# what the user has set for mpirun stays, and would hide what ./run sets
for setting in $(env | sed -n 's/^\(OMPI_[A-Za-z0-9_]*\)=.*/\1/p'); do unset "$setting"; done
top=$work/top
mkdir -p "$top/tools" "$work/bin" "$work/commands"
cp "$sources/run" "$sources/CMakePresets.json" "$top"
cp "$sources/tools/setup.sh" "$sources/tools/ranks.sh" "$top/tools"

# commands of the system, without any MPI that it has
for name in cat chmod cp dirname env find grep kill ls mkdir nproc readlink rm sed sh sleep tail touch gfortran cc make gnuplot; do
   path=$(command -v $name) && case $path in /*) ln -s "$path" "$work/commands/$name" ;; esac
done
ln -s "$(command -v true)" "$work/commands/gnuplot" 2>/dev/null
PATH=$work/bin:$work/commands
export PATH work

stand_in() { # stand_in NAME: the text comes from the standard input
   { echo '#!/bin/sh'; cat; } >"$work/bin/$1"
   chmod +x "$work/bin/$1"
}
echo 'echo 0' | stand_in id
stand_in cmake <<'END'
case $1 in
   --version) echo 'cmake version 3.25.1' ;;
   --preset)
      echo "configure $2" >>"$work/done"
      mkdir -p "build/$2/bin"
      echo "CMAKE_HOME_DIRECTORY:INTERNAL=$PWD" >"build/$2/CMakeCache.txt"
      : >"build/$2/Makefile"
      ;;
   --build)
      echo "build $2" >>"$work/done"
      for program in atrito atrito-mpi; do
         cp "$work/program" "$2/bin/$program"
      done
      ;;
esac
END
stand_in apt-get <<'END'
echo "apt-get $*" >>"$work/done"
[ "$1" = install ] || exit 0
[ ! -e "$work/no-network" ] || exit 100
cp "$work/mpirun" "$work/bin/mpirun"
cp "$work/mpirun" "$work/bin/mpifort"
END
cat >"$work/mpirun" <<'END'
#!/bin/sh
echo "mpirun $*" >>"$work/done"
env | grep '^OMPI_\|^PRTE_' >"$work/settings"
shift 2
if [ "$2" = wait ]; then
   trap 'echo terminated >>"$work/done"; exit 1' TERM
   echo started >"$work/started"
   while :; do sleep 0.05 2>/dev/null || sleep 1; done
fi
exec "$@"
END
cat >"$work/program" <<'END'
#!/bin/sh
echo "${0##*/} $*"
cat >&2
exit "${CODE:-0}"
END
chmod +x "$work/mpirun" "$work/program"

ask() { # ask CODE WORDS: ./run with these words ends so; what it says is in out and err
   wanted=$1
   shift
   : >"$work/done"
   echo 'from outside' | "$top/run" "$@" >"$work/out" 2>"$work/err"
   code=$?
   [ "$code" -eq "$wanted" ] || { fail "./run $*: exit $code, expected $wanted"; cat "$work/err"; }
}

done_so() { # done_so WHAT PATTERN
   grep -q -- "$2" "$work/done" || { fail "$1: not done: $2"; cat "$work/done"; }
}

# a number that is none: told at once
for number in '' 0 00 x 2x -1 1.5 1025 99999; do
   ask 1 --ranks "$number" deck.inp
   grep -qF "wants the number of ranks, 1 to 1024, not '$number'" "$work/err" || fail "--ranks '$number': not told"
   [ "$(grep -c "" "$work/err")" -eq 1 ] || fail "--ranks '$number': more than a line"
   [ -s "$work/done" ] && fail "--ranks '$number': something was done"
done
ask 1 --ranks
grep -q 'wants the number of ranks' "$work/err" || fail '--ranks without a number: not told'
ask 1 deck.inp --ranks
grep -q 'wants the number of ranks' "$work/err" || fail 'deck.inp --ranks: not told'
ask 1 --ranks=two deck.inp
grep -q "not 'two'" "$work/err" || fail '--ranks=two: not told'

# without a network: said, with the packages
touch "$work/no-network"
ask 9 --ranks 2 deck.inp
grep -q 'could not install.* openmpi-bin libopenmpi-dev' "$work/err" || { fail 'packages that cannot be had are not named'; cat "$work/err"; }
rm "$work/no-network"

# the first time
ask 0 --ranks 3 deck.inp --set 'nu=1 2'
done_so 'the first time' 'apt-get install .* openmpi-bin libopenmpi-dev'
done_so 'the first time' '^configure run-mpi$'
done_so 'the first time' '^build build/run-mpi$'
done_so 'the first time' "^mpirun -n 3 $top/build/run-mpi/bin/atrito-mpi deck.inp --set nu=1 2\$"
grep -qx 'atrito-mpi deck.inp --set nu=1 2' "$work/out" || { fail 'the program gets other words'; cat "$work/out"; }
grep -qx 'from outside' "$work/err" || fail 'the program has another standard input'
for setting in OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_orte_execute_quiet=1 \
   OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_hwloc_base_binding_policy=none OMPI_MCA_mpi_yield_when_idle=1 OMPI_MCA_pml=ob1; do
   grep -qx "$setting" "$work/settings" || fail "mpirun without $setting"
done

# where it stands
for words in 'deck.inp --ranks 3 --quiet' 'deck.inp --ranks=3 --quiet' '--ranks 2 deck.inp --quiet --ranks 3'; do
   ask 0 $words
   done_so "$words" "^mpirun -n 3 $top/build/run-mpi/bin/atrito-mpi deck.inp --quiet\$"
done
ask 0 --ranks 3 --quiet -- --ranks
done_so 'behind --' "^mpirun -n 3 $top/build/run-mpi/bin/atrito-mpi --quiet -- --ranks\$"

# from then on; codes of the run are those of ./run
for number in 2 3 4 5 9; do
   CODE=$number
   export CODE
   ask $number --ranks 1 deck.inp
done
unset CODE
grep -q 'apt-get\|configure' "$work/done" && fail 'installed or configured again'
touch -d '+1 hour' "$top/CMakePresets.json" 2>/dev/null && { ask 0 --ranks 2 deck.inp; done_so 'other presets' '^configure run-mpi$'; }
touch "$top/CMakePresets.json"

# what the user has set stays, and a batch system's network does
OMPI_MCA_hwloc_base_binding_policy=core OMPI_MCA_pml=ucx ask 0 --ranks 2 deck.inp
grep -qx OMPI_MCA_hwloc_base_binding_policy=core "$work/settings" && grep -qx OMPI_MCA_pml=ucx "$work/settings" || fail 'the settings of the user are lost'
SLURM_JOB_ID=1 ask 0 --ranks 2 deck.inp
grep -q OMPI_MCA_pml= "$work/settings" && fail 'a batch system: the network is not looked for'
echo 'echo 1000' | stand_in id
ask 0 --ranks 2 deck.inp
grep -q ROOT "$work/settings" && fail 'root is allowed for a user'

# a rank that was killed
CODE=137
export CODE
ask 137 --ranks 2 deck.inp
unset CODE
grep -q 'E-INTERRUPTED.* a rank was killed' "$work/err" || fail 'a killed rank: not told'

# signals go on to mpirun, once, which ends with 1 then; the code is that of the signal
for signal in TERM:143 HUP:129; do
   rm -f "$work/started"
   : >"$work/done"
   "$top/run" --ranks 2 wait </dev/null >"$work/out" 2>"$work/err" &
   run=$!
   until [ -s "$work/started" ]; do pause; done
   kill -"${signal%:*}" $run
   wait $run
   code=$?
   [ "$code" -eq "${signal#*:}" ] || fail "SIG${signal%:*}: exit $code"
   [ "$(grep -c terminated "$work/done")" -eq 1 ] || fail "SIG${signal%:*}: mpirun is not told, or told twice"
done

# without --ranks no MPI
ask 0 deck.inp
done_so 'without --ranks' '^build build/run$'
grep -q mpi "$work/done" && fail 'MPI without --ranks'
finish
