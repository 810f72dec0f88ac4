# MPI for atrito-mpi. Target: MPI::MPI_Fortran.
include_guard()

find_package(MPI COMPONENTS Fortran QUIET)
if(NOT MPI_Fortran_FOUND OR NOT MPI_Fortran_HAVE_F08_MODULE)
   message(FATAL_ERROR "MPI with its module mpi_f08 is missing: install libopenmpi-dev and openmpi-bin (Debian, Ubuntu), or configure "
      "with -DATRITO_MPI=OFF for the plain program alone")
endif()
message(STATUS "MPI ${MPI_Fortran_VERSION}, ${MPIEXEC_EXECUTABLE}")
