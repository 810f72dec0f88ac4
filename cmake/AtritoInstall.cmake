# What `cmake --install` installs, and the package of `cpack`: docs/user/install.md.
#
# Manual page and completion are printed by the program itself, from its tables of options and keywords.
include_guard()
include(GNUInstallDirs)

if(NOT CMAKE_CROSSCOMPILING)
   set(guides ${PROJECT_BINARY_DIR}/guides)
   set(guide_files)
   foreach(guide man:atrito.1 bash:atrito)
      string(REPLACE ":" ";" guide ${guide})
      list(GET guide 0 topic)
      list(GET guide 1 name)
      set(file ${guides}/${topic}/${name})
      list(APPEND guide_files ${file})
      add_custom_command(OUTPUT ${file}
         COMMAND ${CMAKE_COMMAND} -E make_directory ${guides}/${topic}
         COMMAND atrito help ${topic} > ${file}
         DEPENDS atrito VERBATIM)
   endforeach()
   add_custom_target(atrito_guides ALL DEPENDS ${guide_files})
   install(FILES ${guides}/man/atrito.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
   install(FILES ${guides}/bash/atrito DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
endif()

# The pages of docs/ keep their places relative to each other and to the decks.
install(DIRECTORY input DESTINATION ${CMAKE_INSTALL_DATADIR}/atrito)
install(FILES README.md LICENSE CHANGELOG.md CITATION.cff CONTRIBUTING.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} PATTERN "make-*" EXCLUDE PATTERN "manual" EXCLUDE)

# The same pages as one book, HTML and PDF, where `--target manual` has made it.
find_program(ATRITO_PYTHON python3)
if(ATRITO_PYTHON)
   add_custom_target(manual COMMAND ${ATRITO_PYTHON} ${PROJECT_SOURCE_DIR}/docs/manual/make ${PROJECT_BINARY_DIR}/manual USES_TERMINAL VERBATIM)
endif()
install(DIRECTORY ${PROJECT_BINARY_DIR}/manual/html DESTINATION ${CMAKE_INSTALL_DOCDIR} OPTIONAL)
install(FILES ${PROJECT_BINARY_DIR}/manual/atrito.pdf DESTINATION ${CMAKE_INSTALL_DOCDIR} OPTIONAL)

# The laboratory, which runs by Python's standard library (docs/labs/README.md).
install(PROGRAMS tools/lab/atrito-lab DESTINATION ${CMAKE_INSTALL_BINDIR})
install(FILES tools/lab/atrito-lab.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(DIRECTORY tools/lab/ DESTINATION ${CMAKE_INSTALL_DATADIR}/atrito/lab FILES_MATCHING PATTERN "*.py" PATTERN "*.css")

# ---- the package ----

# The packages whose libraries the program loads when it needs them: atrito_package_of(<file or soname> <variable>)
function(atrito_package_of file variable)
   set(${variable} "" PARENT_SCOPE)
   if(DPKG_QUERY AND file)
      get_filename_component(name ${file} NAME)
      execute_process(COMMAND ${DPKG_QUERY} --search "*/${name}" OUTPUT_VARIABLE owners ERROR_QUIET)
      if(owners MATCHES "^([a-z0-9.+-]+)")
         set(${variable} ${CMAKE_MATCH_1} PARENT_SCOPE)
      endif()
   endif()
endfunction()

find_program(DPKG_QUERY dpkg-query)
mark_as_advanced(DPKG_QUERY)
set(recommended "gnuplot-nox | gnuplot" python3)
foreach(file "${ATRITO_CLP_FILE}" "${ATRITO_METIS_FILE}")
   atrito_package_of("${file}" package)
   if(package)
      list(APPEND recommended ${package})
   endif()
endforeach()
list(JOIN recommended ", " CPACK_DEBIAN_PACKAGE_RECOMMENDS)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME atrito)
set(CPACK_PACKAGE_VENDOR "the atrito authors")
set(ATRITO_MAINTAINER "the atrito authors <atrito@example.org>" CACHE STRING "Who makes the package: name <address>")
set(CPACK_PACKAGE_CONTACT "${ATRITO_MAINTAINER}")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "contact with friction between elastic bodies by finite elements")
set(CPACK_PACKAGE_DESCRIPTION "\
Linear elastic bodies in the plane or of revolution that touch with
friction. A deck of keywords goes in, in the tradition of Abaqus and
CalculiX; text tables and a printed listing come out, with pictures,
field files, sweeps of parameters and convergence studies.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/DebianFiles.cmake)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_THREADS 1)
include(CPack)
