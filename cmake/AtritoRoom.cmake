# One static library a folder of src/, with a module directory of its own. A room sees the
# modules of the rooms that it names, and of no other: the compiler refuses an upward `use`.
#
#   atrito_add_room(<room> SOURCES <file>... USES <room>... [HIDES <room>...] [LIBRARIES <lib>...])
#
# USES is passed on to whoever uses this room; HIDES is seen by this room alone.
include_guard()

set(ATRITO_WARNINGS -Wall -Wextra -Wimplicit-interface -Wimplicit-procedure -Wunused-parameter
   -Wno-uninitialized -Wno-maybe-uninitialized -Wno-compare-reals
   -Wno-function-elimination)

add_library(atrito_options INTERFACE)
target_compile_options(atrito_options INTERFACE
   $<$<COMPILE_LANG_AND_ID:Fortran,GNU>:-std=f2018 -fimplicit-none -ffree-line-length-132 ${ATRITO_WARNINGS}>
   $<$<COMPILE_LANG_AND_ID:C,GNU,Clang>:-std=c11 -Wall -Wextra>)
if(ATRITO_WERROR)
   target_compile_options(atrito_options INTERFACE $<$<COMPILE_LANG_AND_ID:Fortran,GNU>:-Werror> $<$<COMPILE_LANG_AND_ID:C,GNU,Clang>:-Werror>)
endif()
if(ATRITO_CHECKS)
   target_compile_options(atrito_options INTERFACE $<$<COMPILE_LANG_AND_ID:Fortran,GNU>:
      -fcheck=all,no-array-temps -ffpe-trap=invalid,zero,overflow -finit-real=snan -finit-derived -fbacktrace>)
endif()
if(ATRITO_SANITIZE)
   # add_compile_options and not atrito_options: everything that is linked must agree on it, the tests as well
   add_compile_options(-fsanitize=address,undefined
      $<$<COMPILE_LANG_AND_ID:Fortran,GNU>:-fcheck=all,no-array-temps> -g -fno-omit-frame-pointer)
   add_link_options(-fsanitize=address,undefined)
endif()

function(atrito_add_room room)
   cmake_parse_arguments(ARG "" "" "SOURCES;USES;HIDES;LIBRARIES" ${ARGN})
   set(modules ${PROJECT_BINARY_DIR}/modules/${room})
   add_library(atrito_${room} STATIC ${ARG_SOURCES})
   set_target_properties(atrito_${room} PROPERTIES Fortran_MODULE_DIRECTORY ${modules})
   target_include_directories(atrito_${room} PUBLIC ${modules})
   target_link_libraries(atrito_${room} PRIVATE atrito_options)
   foreach(other IN LISTS ARG_USES)
      target_link_libraries(atrito_${room} PUBLIC atrito_${other})
   endforeach()
   foreach(other IN LISTS ARG_HIDES)
      target_link_libraries(atrito_${room} PRIVATE atrito_${other})
   endforeach()
   target_link_libraries(atrito_${room} PUBLIC ${ARG_LIBRARIES})
endfunction()
