# What `./run --ranks N` does: the same run by N ranks (MPI) on this machine. POSIX sh, to be sourced behind setup.sh.

MOST_RANKS=1024

wrong_ranks() {
   echo "atrito: error [E-USAGE] --ranks wants the number of ranks, 1 to $MOST_RANKS, not '$1'; for example ./run --ranks 2 DECK.inp" >&2
   exit 1
}

# judge_ranks TEXT: comes back when it is a number of ranks.
judge_ranks() {
   case $1 in
      '' | *[!0-9]* | 0* | ?????*) wrong_ranks "$1" ;;
   esac
   [ "$1" -le "$MOST_RANKS" ] || wrong_ranks "$1"
}

# What Debian and Ubuntu lack for atrito-mpi.
missing_rank_packages() {
   command -v mpirun >/dev/null 2>&1 || printf ' openmpi-bin'
   command -v mpifort >/dev/null 2>&1 || printf ' libopenmpi-dev'
   found_library libdmumps.so || printf ' libmumps-dev'
   found_metis || printf ' libmetis-dev'
}

# Installs it; nothing to do is nothing said.
install_for_ranks() {
   packages=$(missing_rank_packages)
   [ -z "$packages" ] || install_packages "$packages"
}

# What Open MPI is told, unless the user has told it already: it runs as root (in containers), with more ranks than cores, binds
# no rank to a core, lets a rank that waits give way to those that work, and says nothing of its own behind atrito's message.
# Where no batch system spreads the ranks over machines it looks for no network, which takes longer than a small deck. Other MPIs do
# not read this.
prepare_mpirun() {
   if [ "$(id -u)" -eq 0 ]; then
      export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
   fi
   export OMPI_MCA_orte_execute_quiet="${OMPI_MCA_orte_execute_quiet-1}"
   export OMPI_MCA_rmaps_base_oversubscribe="${OMPI_MCA_rmaps_base_oversubscribe-1}"
   export PRTE_MCA_rmaps_default_mapping_policy="${PRTE_MCA_rmaps_default_mapping_policy-:oversubscribe}"
   export OMPI_MCA_hwloc_base_binding_policy="${OMPI_MCA_hwloc_base_binding_policy-none}"
   export OMPI_MCA_mpi_yield_when_idle="${OMPI_MCA_mpi_yield_when_idle-1}"
   [ -z "${SLURM_JOB_ID:-}${PBS_JOBID:-}${LSB_JOBID:-}" ] || return 0
   export OMPI_MCA_pml="${OMPI_MCA_pml-ob1}"
   export OMPI_MCA_btl="${OMPI_MCA_btl-self,vader}"
   export OMPI_MCA_osc="${OMPI_MCA_osc-^ucx}"
}

# end_ranks SIGNAL NUMBER: has mpirun end all ranks, once; a second signal would have it end them without cleaning up. Ctrl-C at a
# terminal has come to mpirun as well.
end_ranks() {
   [ -z "$ended_by" ] || return 0
   ended_by=$2
   if [ "$1" != INT ] || [ ! -t 0 ]; then kill -TERM "$mpirun_process" 2>/dev/null; fi
}

# run_ranks N PROGRAM ARGUMENTS: ends with the exit code of the run.
run_ranks() {
   n=$1
   shift
   prepare_mpirun
   ended_by=
   exec 3<&0
   mpirun -n "$n" "$@" <&3 3<&- &
   mpirun_process=$!
   trap 'end_ranks HUP 129' HUP
   trap 'end_ranks INT 130' INT
   trap 'end_ranks TERM 143' TERM
   wait "$mpirun_process"
   code=$?
   while kill -0 "$mpirun_process" 2>/dev/null; do             # a signal ends wait before mpirun has ended
      wait "$mpirun_process"
      code=$?
   done
   [ -z "$ended_by" ] || [ "$code" -eq 0 ] || code=$ended_by
   if [ "$code" -eq 137 ]; then
      say "error [E-INTERRUPTED] a rank was killed (SIGKILL), as a system that is out of memory does; files that were not complete are removed by the next run"
   fi
   exit "$code"
}
