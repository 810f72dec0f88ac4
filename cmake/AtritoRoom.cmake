# One static library a folder of src/, with a module directory of its own. A room sees the
# modules of the rooms that it names, and of no other: the compiler refuses an upward `use`.
#
#   atrito_add_room(<room> [LIGHT] SOURCES <file>... [FACE <module>...] USES <room>... [HIDES <room>...] [LIBRARIES <lib>...])
#
# LIGHT is a room whose own procedures take next to nothing of a run: an optimised build compiles it with -O1, in half the time.
# FACE are the modules, without `atrito_`, that other rooms may use; the compiler refuses the rest. Without it all may be used.
# USES is passed on to whoever uses this room; HIDES is seen by this room alone. Tests look inside, too: atrito_test_options.
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
   cmake_parse_arguments(ARG "LIGHT" "" "SOURCES;FACE;USES;HIDES;LIBRARIES" ${ARGN})
   set(modules ${PROJECT_BINARY_DIR}/modules/${room})
   add_library(atrito_${room} STATIC ${ARG_SOURCES})
   set_target_properties(atrito_${room} PROPERTIES Fortran_MODULE_DIRECTORY ${modules})
   set_property(GLOBAL APPEND PROPERTY ATRITO_MODULE_FOLDERS ${modules})
   if(ARG_FACE)
      # what the face is made of goes into a folder of its own, the only one that others search
      set(face ${ARG_FACE})
      list(TRANSFORM face REPLACE "(.+)" "${modules}/atrito_\\1.mod")
      file(MAKE_DIRECTORY ${modules}/face)
      add_custom_command(TARGET atrito_${room} POST_BUILD COMMAND ${CMAKE_COMMAND} -E copy_if_different ${face} ${modules}/face)
      target_include_directories(atrito_${room} PRIVATE ${modules} INTERFACE ${modules}/face)
   else()
      target_include_directories(atrito_${room} PUBLIC ${modules})
   endif()
   target_link_libraries(atrito_${room} PRIVATE atrito_options)
   if(ARG_LIGHT)
      target_compile_options(atrito_${room} PRIVATE $<$<AND:$<CONFIG:Release>,$<COMPILE_LANG_AND_ID:Fortran,GNU>>:-O1>)
   endif()
   foreach(other IN LISTS ARG_USES)
      target_link_libraries(atrito_${room} PUBLIC atrito_${other})
   endforeach()
   foreach(other IN LISTS ARG_HIDES)
      target_link_libraries(atrito_${room} PRIVATE atrito_${other})
   endforeach()
   target_link_libraries(atrito_${room} PUBLIC ${ARG_LIBRARIES})
endfunction()

# Texts that become modules: their lines in Fortran, with --whole as they stand.
function(atrito_text_lines name)
   cmake_parse_arguments(ARG "--whole" "" "" ${ARGN})
   set(files ${ARG_UNPARSED_ARGUMENTS})
   list(TRANSFORM files PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)
   set(whole $<$<BOOL:${ARG_--whole}>:--whole>)
   add_custom_command(OUTPUT atrito_${name}.f90
      COMMAND sh ${PROJECT_SOURCE_DIR}/tools/text-lines ${whole} ${name} ${files} > atrito_${name}.f90
      DEPENDS ${files} ${PROJECT_SOURCE_DIR}/tools/text-lines VERBATIM COMMAND_EXPAND_LISTS)
endfunction()
