# pFUnit's add_pfunit_ctest where pFUnit is missing; arguments as in pFUnit 4.14:
#
#   add_pfunit_ctest(<name> TEST_SOURCES <file.pf>... [OTHER_SOURCES <file>...]
#      [LINK_LIBRARIES <target>...] [LABELS <label>...] [WORKING_DIRECTORY <folder>])
#
# Builds the program <name> and registers it as one test of ctest. The stand-in itself is compiled
# with the flags of the folder that includes this file, and with atrito_options where that exists.
include_guard(GLOBAL)

find_program(ATRITO_AWK NAMES mawk awk gawk REQUIRED DOC "POSIX awk that translates .pf files")
set(ATRITO_STANDIN_DIR ${CMAKE_CURRENT_LIST_DIR} CACHE INTERNAL "Stand-in for pFUnit")

include(${ATRITO_STANDIN_DIR}/funit.cmake)
add_library(atrito_funit STATIC ${ATRITO_STANDIN_DIR}/funit_runner.f90 ${ATRITO_STANDIN_DIR}/funit_assertions.f90 ${ATRITO_FUNIT})
set(ATRITO_FUNIT_MODULES ${PROJECT_BINARY_DIR}/modules/funit)
set_target_properties(atrito_funit PROPERTIES Fortran_MODULE_DIRECTORY ${ATRITO_FUNIT_MODULES})
target_include_directories(atrito_funit PUBLIC ${ATRITO_FUNIT_MODULES})
if(TARGET atrito_options)
   target_link_libraries(atrito_funit PRIVATE atrito_options)
endif()

# The program without its test: the must-fail tests of the stand-in run it in their own way.
function(atrito_add_standin_program name)
   cmake_parse_arguments(PARSE_ARGV 1 ARG "" "" "TEST_SOURCES;OTHER_SOURCES;LINK_LIBRARIES")
   if(NOT ARG_TEST_SOURCES)
      message(FATAL_ERROR "add_pfunit_ctest(${name}): no TEST_SOURCES")
   endif()
   set(uses "")
   set(calls "")
   set(sources "")
   foreach(pf IN LISTS ARG_TEST_SOURCES)
      cmake_path(ABSOLUTE_PATH pf NORMALIZE)
      cmake_path(GET pf STEM suite)
      set(f90 ${CMAKE_CURRENT_BINARY_DIR}/${name}_pf/${suite}.F90)
      add_custom_command(OUTPUT ${f90}
         COMMAND ${ATRITO_AWK} -v out=${f90} -f ${ATRITO_STANDIN_DIR}/pf2f90.awk ${pf}
         DEPENDS ${pf} ${ATRITO_STANDIN_DIR}/pf2f90.awk
         COMMENT "Translating ${suite}.pf"
         VERBATIM)
      list(APPEND sources ${f90})
      string(APPEND uses "   use wrap${suite}, only: ${suite}_suite\n")
      string(APPEND calls "   call ${suite}_suite()\n")
   endforeach()
   file(MAKE_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/${name}_pf)

   set(driver ${CMAKE_CURRENT_BINARY_DIR}/${name}_pf/${name}_driver.f90)
   file(CONFIGURE OUTPUT ${driver} @ONLY CONTENT
"program ${name}_driver
   use funit, only: finish_tests
${uses}   implicit none (type, external)
${calls}   call finish_tests()
end program ${name}_driver
")
   add_executable(${name} ${sources} ${ARG_OTHER_SOURCES} ${driver})
   set(modules ${CMAKE_CURRENT_BINARY_DIR}/mod/${name})
   set_target_properties(${name} PROPERTIES Fortran_MODULE_DIRECTORY ${modules})
   target_include_directories(${name} PRIVATE ${modules} ${CMAKE_CURRENT_SOURCE_DIR})
   target_link_libraries(${name} ${ARG_LINK_LIBRARIES} atrito_funit) # plain signature, as pFUnit
endfunction()

function(add_pfunit_ctest name)
   set(unsupported REGISTRY MAX_PES EXTRA_USE EXTRA_INITIALIZE EXTRA_FINALIZE)
   cmake_parse_arguments(PARSE_ARGV 1 ARG "" "WORKING_DIRECTORY;${unsupported}"
      "TEST_SOURCES;OTHER_SOURCES;LINK_LIBRARIES;LABELS")
   if(ARG_UNPARSED_ARGUMENTS)
      message(FATAL_ERROR "add_pfunit_ctest(${name}): unknown ${ARG_UNPARSED_ARGUMENTS}")
   endif()
   foreach(argument IN LISTS unsupported)
      if(DEFINED ARG_${argument})
         message(FATAL_ERROR "add_pfunit_ctest(${name}): the stand-in for pFUnit knows no ${argument}")
      endif()
   endforeach()
   if(NOT ARG_WORKING_DIRECTORY)
      set(ARG_WORKING_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR})
   endif()

   atrito_add_standin_program(${name} TEST_SOURCES ${ARG_TEST_SOURCES}
      OTHER_SOURCES ${ARG_OTHER_SOURCES} LINK_LIBRARIES ${ARG_LINK_LIBRARIES})
   add_test(NAME ${name} COMMAND ${name} WORKING_DIRECTORY ${ARG_WORKING_DIRECTORY})
   set_tests_properties(${name} PROPERTIES LABELS "${ARG_LABELS}")
endfunction()
