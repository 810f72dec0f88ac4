/* To be loaded before MPI: its end goes wrong when all is done, as that of Open MPI 4.1 does now and then. */
#include <signal.h>

int PMPI_Finalize(void);

void mpi_finalize_f08_(int *error) {
   int code = PMPI_Finalize();
   if (error)
      *error = code;
   raise(SIGSEGV);
}
