# METIS, which orders bodies whose elements are graded or lie askew. Sets ATRITO_METIS_FOUND, and then ATRITO_METIS_FILE (what the
# program loads when it needs it: the name with the version, as the linker would take it) and ATRITO_METIS_VERSION.
#
# It is not linked: few runs need it, and every start of the program would pay for it. The program hands it integers and reals of 32 bits; a
# METIS with others is as good as none, so its header is read.
include_guard()

set(ATRITO_METIS_FOUND FALSE)
find_path(ATRITO_METIS_INCLUDE_DIR metis.h)
find_library(ATRITO_METIS_LIBRARY_PATH NAMES metis)
mark_as_advanced(ATRITO_METIS_INCLUDE_DIR ATRITO_METIS_LIBRARY_PATH)

if(ATRITO_METIS_INCLUDE_DIR AND ATRITO_METIS_LIBRARY_PATH)
   file(READ ${ATRITO_METIS_INCLUDE_DIR}/metis.h header)
   if(header MATCHES "define +IDXTYPEWIDTH +32" AND header MATCHES "define +REALTYPEWIDTH +32")
      set(ATRITO_METIS_FILE ${ATRITO_METIS_LIBRARY_PATH})
      if(CMAKE_OBJDUMP)
         execute_process(COMMAND ${CMAKE_OBJDUMP} -p ${ATRITO_METIS_LIBRARY_PATH} OUTPUT_VARIABLE headers ERROR_QUIET)
         if(headers MATCHES "SONAME +([^ \n]+)")
            set(ATRITO_METIS_FILE ${CMAKE_MATCH_1})
         endif()
      endif()
      set(ATRITO_METIS_VERSION "")
      foreach(part MAJOR MINOR SUBMINOR)
         if(header MATCHES "define +METIS_VER_${part} +([0-9]+)")
            string(APPEND ATRITO_METIS_VERSION ".${CMAKE_MATCH_1}")
         endif()
      endforeach()
      string(REGEX REPLACE "^[.]" "" ATRITO_METIS_VERSION "${ATRITO_METIS_VERSION}")
      set(ATRITO_METIS_FOUND TRUE)
   endif()
endif()

if(ATRITO_METIS_FOUND)
   message(STATUS "METIS ${ATRITO_METIS_VERSION}, ${ATRITO_METIS_FILE}, loaded when it is asked for")
else()
   message(STATUS "METIS is missing: graded meshes are ordered by the places of their elements alone; libmetis-dev (Debian, Ubuntu) has it")
endif()
