# Unit tests: pFUnit where it is installed, else the stand-in that compiles the same .pf files.
# Afterwards add_pfunit_ctest is there in either case; docs/developer/testing.md shows a call.
# Include it in the top folder: the variables of find_package are seen in its subfolders only.
include_guard()

option(ATRITO_FORCE_STANDIN "Compile .pf tests with the stand-in even where pFUnit is installed" OFF)

if(NOT ATRITO_FORCE_STANDIN)
   find_package(PFUNIT 4.14 QUIET)
endif()

# The flags of the tests. What pFUnit generates is not free of warnings, so there they are no errors.
add_library(atrito_test_options INTERFACE)
if(PFUNIT_FOUND AND NOT ATRITO_FORCE_STANDIN)
   set(ATRITO_STANDIN OFF)
   message(STATUS "Unit tests: pFUnit ${PFUNIT_VERSION} (${PFUNIT_DIR})")
   target_compile_options(atrito_test_options INTERFACE
      $<TARGET_PROPERTY:atrito_options,INTERFACE_COMPILE_OPTIONS>
      $<$<COMPILE_LANG_AND_ID:Fortran,GNU>:-Wno-error>)
else()
   set(ATRITO_STANDIN ON)
   if(ATRITO_FORCE_STANDIN)
      message(STATUS "Unit tests: stand-in for pFUnit (ATRITO_FORCE_STANDIN)")
   else()
      message(STATUS "Unit tests: stand-in for pFUnit (no pFUnit 4.14 found; set PFUNIT_DIR or CMAKE_PREFIX_PATH)")
   endif()
   target_link_libraries(atrito_test_options INTERFACE atrito_options)
   include(${PROJECT_SOURCE_DIR}/tests/pfunit_standin/add_pfunit_ctest.cmake)
endif()
