# Clp, the simplex method of COIN-OR, which proves that a scene has no equilibrium. Sets ATRITO_CLP_FOUND, and then ATRITO_CLP_FILE: what
# the program loads when it needs it, the name with the version, as the linker would take it.
#
# It is not linked: few runs need it, and every start of the program would pay for it. Only C's types cross the interface, so no
# header is needed.
include_guard()

set(ATRITO_CLP_FOUND FALSE)
find_library(ATRITO_CLP_LIBRARY_PATH NAMES Clp)
mark_as_advanced(ATRITO_CLP_LIBRARY_PATH)

if(ATRITO_CLP_LIBRARY_PATH)
   set(ATRITO_CLP_FILE ${ATRITO_CLP_LIBRARY_PATH})
   if(CMAKE_OBJDUMP)
      execute_process(COMMAND ${CMAKE_OBJDUMP} -p ${ATRITO_CLP_LIBRARY_PATH} OUTPUT_VARIABLE headers ERROR_QUIET)
      if(headers MATCHES "SONAME +([^ \n]+)")
         set(ATRITO_CLP_FILE ${CMAKE_MATCH_1})
      endif()
   endif()
   set(ATRITO_CLP_FOUND TRUE)
   message(STATUS "Clp, ${ATRITO_CLP_FILE}, loaded when it is asked for")
else()
   message(STATUS "Clp is missing: that a scene has no equilibrium cannot be proved (exit 3 in place of 4); coinor-libclp-dev (Debian, Ubuntu) has it")
endif()
