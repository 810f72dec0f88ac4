# MUMPS, sequential, for tests. Sets ATRITO_MUMPS_FOUND, and then ATRITO_MUMPS_INCLUDE_DIR, ATRITO_MUMPS_FILE (what
# they load: the name with the version, as the linker would take it) and ATRITO_MUMPS_VERSION. With
# ATRITO_MPI also ATRITO_MUMPS_RANKS_FILE, the one of the same version for ranks, which atrito-mpi loads; it must be there then.
#
# It is not linked: Debian's static library wants the shared ones of Scotch all the same, and linking the shared one costs every
# start of the program a millisecond, of which a small deck takes four.
include_guard()

# The name inside a library: the linker would write it into the program.
function(atrito_soname_of library name)
   set(${name} ${library} PARENT_SCOPE)
   if(CMAKE_OBJDUMP)
      execute_process(COMMAND ${CMAKE_OBJDUMP} -p ${library} OUTPUT_VARIABLE headers ERROR_QUIET)
      if(headers MATCHES "SONAME +([^ \n]+)")
         set(${name} ${CMAKE_MATCH_1} PARENT_SCOPE)
      endif()
   endif()
endfunction()

set(ATRITO_MUMPS_FOUND FALSE)
find_path(ATRITO_MUMPS_INCLUDE_DIR dmumps_struc.h PATH_SUFFIXES mumps MUMPS mumps_seq)
find_library(ATRITO_MUMPS_LIBRARY_PATH NAMES dmumps_seq)
set(ATRITO_MUMPS_VERSION "")
if(EXISTS ${ATRITO_MUMPS_INCLUDE_DIR}/dmumps_c.h)
   file(STRINGS ${ATRITO_MUMPS_INCLUDE_DIR}/dmumps_c.h line REGEX "define MUMPS_VERSION ")
   if(line MATCHES "\"([0-9.]+)\"")
      set(ATRITO_MUMPS_VERSION ${CMAKE_MATCH_1})
   endif()
endif()
mark_as_advanced(ATRITO_MUMPS_INCLUDE_DIR ATRITO_MUMPS_LIBRARY_PATH)

if(ATRITO_MUMPS_INCLUDE_DIR AND ATRITO_MUMPS_VERSION AND ATRITO_MUMPS_LIBRARY_PATH AND CMAKE_Fortran_COMPILER_ID STREQUAL GNU)
   atrito_soname_of(${ATRITO_MUMPS_LIBRARY_PATH} ATRITO_MUMPS_FILE)
   set(ATRITO_MUMPS_FOUND TRUE)
   message(STATUS "MUMPS ${ATRITO_MUMPS_VERSION}, ${ATRITO_MUMPS_FILE}, loaded when it is asked for")
else()
   message(STATUS "MUMPS is missing: no limit program (tests/bench); libmumps-seq-dev (Debian, Ubuntu) has it")
endif()

set(ATRITO_MUMPS_RANKS_FILE "")
if(ATRITO_MPI)
   find_library(ATRITO_MUMPS_RANKS_LIBRARY_PATH NAMES dmumps)
   mark_as_advanced(ATRITO_MUMPS_RANKS_LIBRARY_PATH)
   if(NOT ATRITO_MUMPS_FOUND OR NOT ATRITO_MUMPS_RANKS_LIBRARY_PATH)
      message(FATAL_ERROR "MUMPS for ranks is missing, which atrito-mpi needs: install libmumps-dev and libmumps-seq-dev (Debian, "
         "Ubuntu), or configure with -DATRITO_MPI=OFF for the plain program alone")
   endif()
   atrito_soname_of(${ATRITO_MUMPS_RANKS_LIBRARY_PATH} ATRITO_MUMPS_RANKS_FILE)
   message(STATUS "MUMPS for ranks: ${ATRITO_MUMPS_RANKS_FILE}")
endif()
