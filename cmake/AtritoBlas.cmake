# LAPACK and BLAS, as the target atrito_blas.
#
# The program, a target with the property ATRITO_OWN_BLAS, takes the archive of OpenBLAS that stands beside the shared library, where it
# links: of the 12,000 relocations of the shared one every start pays the look-up, a third of the instructions of example 1. Tests, of
# which there are a hundred, take the shared one: the archive is 26 MB.
include_guard()
include(CheckFortranSourceCompiles)

find_package(LAPACK REQUIRED)
add_library(atrito_blas INTERFACE)
list(GET LAPACK_LIBRARIES 0 shared)
string(REGEX REPLACE "[.]so$" ".a" archive "${shared}")
set(ATRITO_STATIC_BLAS OFF)
if(CMAKE_SYSTEM_NAME STREQUAL Linux AND archive MATCHES "openblas.*[.]a$" AND EXISTS "${archive}")
   set(CMAKE_REQUIRED_LIBRARIES ${archive} Threads::Threads)
   check_fortran_source_compiles("
      program links
         external dpotrf, dgemm
         call dpotrf
         call dgemm
      end program links" ATRITO_STATIC_BLAS_LINKS SRC_EXT f90)
   unset(CMAKE_REQUIRED_LIBRARIES)
   set(ATRITO_STATIC_BLAS ${ATRITO_STATIC_BLAS_LINKS})
endif()
if(ATRITO_STATIC_BLAS)
   target_link_libraries(atrito_blas INTERFACE
      "$<IF:$<BOOL:$<TARGET_PROPERTY:ATRITO_OWN_BLAS>>,${archive};Threads::Threads,LAPACK::LAPACK>")
   message(STATUS "BLAS: ${archive}, linked statically into the program")
else()
   target_link_libraries(atrito_blas INTERFACE LAPACK::LAPACK)
   message(STATUS "BLAS: ${shared}")
endif()
