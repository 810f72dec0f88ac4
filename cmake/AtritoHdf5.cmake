# HDF5 with its Fortran modules, for the field files. Target: atrito_hdf5_library.
#
# The static libraries are taken where they link: Debian's shared one loads thirty others (curl, Kerberos, LDAP) at every start
# of the program, which takes longer than solving a small deck, and most decks ask for no field file.
include_guard()
include(CheckFortranSourceCompiles)

set(HDF5_USE_STATIC_LIBRARIES ON)
find_package(HDF5 COMPONENTS Fortran QUIET)
set(as_needed)
if(HDF5_FOUND AND CMAKE_SYSTEM_NAME STREQUAL Linux)
   set(as_needed LINKER:--as-needed)
   set(CMAKE_REQUIRED_LINK_OPTIONS ${as_needed})
   set(CMAKE_REQUIRED_INCLUDES ${HDF5_Fortran_INCLUDE_DIRS})
   set(CMAKE_REQUIRED_LIBRARIES ${HDF5_Fortran_LIBRARIES})
   check_fortran_source_compiles("
      program links
         use hdf5, only: h5open_f
         integer :: error
         call h5open_f(error)
      end program links" ATRITO_HDF5_STATIC SRC_EXT f90)
   unset(CMAKE_REQUIRED_LINK_OPTIONS)
   unset(CMAKE_REQUIRED_INCLUDES)
   unset(CMAKE_REQUIRED_LIBRARIES)
endif()
if(NOT ATRITO_HDF5_STATIC)
   # what was found statically stays in the cache otherwise
   get_cmake_property(names CACHE_VARIABLES)
   list(FILTER names INCLUDE REGEX "^HDF5_.*(LIBRARY|LIBRARIES)")
   foreach(name IN LISTS names)
      unset(${name} CACHE)
   endforeach()
   set(as_needed)
   set(HDF5_USE_STATIC_LIBRARIES OFF)
   find_package(HDF5 COMPONENTS Fortran QUIET)
endif()
if(NOT HDF5_FOUND)
   message(FATAL_ERROR "HDF5 with its Fortran modules is missing: install libhdf5-dev (Debian, Ubuntu), or configure with "
      "-DATRITO_HDF5=OFF for a program that refuses *NODE FILE, *EL FILE and *CONTACT FILE")
endif()

add_library(atrito_hdf5_library INTERFACE)
target_include_directories(atrito_hdf5_library SYSTEM INTERFACE ${HDF5_Fortran_INCLUDE_DIRS})
target_link_libraries(atrito_hdf5_library INTERFACE ${HDF5_Fortran_LIBRARIES})
target_link_options(atrito_hdf5_library INTERFACE ${as_needed})
if(ATRITO_HDF5_STATIC)
   message(STATUS "HDF5 ${HDF5_VERSION}, linked statically")
else()
   message(STATUS "HDF5 ${HDF5_VERSION}, linked dynamically")
endif()
