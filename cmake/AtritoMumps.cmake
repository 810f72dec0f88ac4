# MUMPS, sequential, which checks the sparse solver. Sets ATRITO_MUMPS_FOUND, and then ATRITO_MUMPS_INCLUDE_DIR, ATRITO_MUMPS_FILE (what
# the program loads when it needs it: the name with the version, as the linker would take it) and ATRITO_MUMPS_VERSION.
#
# It is not linked: Debian's static library wants the shared ones of Scotch all the same, and linking the shared one costs every
# start of the program a millisecond, of which a small deck takes four.
include_guard()

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
   # the name inside the library: the linker would write it into the program
   set(ATRITO_MUMPS_FILE ${ATRITO_MUMPS_LIBRARY_PATH})
   if(CMAKE_OBJDUMP)
      execute_process(COMMAND ${CMAKE_OBJDUMP} -p ${ATRITO_MUMPS_LIBRARY_PATH} OUTPUT_VARIABLE headers ERROR_QUIET)
      if(headers MATCHES "SONAME +([^ \n]+)")
         set(ATRITO_MUMPS_FILE ${CMAKE_MATCH_1})
      endif()
   endif()
   set(ATRITO_MUMPS_FOUND TRUE)
   message(STATUS "MUMPS ${ATRITO_MUMPS_VERSION}, ${ATRITO_MUMPS_FILE}, loaded when it is asked for")
else()
   message(STATUS "MUMPS is missing: no --solver mumps, no limit program (tests/bench); libmumps-seq-dev (Debian, Ubuntu) has it")
endif()
