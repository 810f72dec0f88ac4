# What Debian wants other than `cmake --install` leaves it: a file `copyright`, a changelog in its own format, pages and changelogs
# compressed. SOURCE_DATE_EPOCH sets the date. CPack runs this in the staged files before it makes the package.
set(usr ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/usr)
set(doc ${usr}/share/doc/${CPACK_PACKAGE_NAME})

file(READ ${doc}/LICENSE license)
file(WRITE ${doc}/copyright "${CPACK_PACKAGE_NAME}: ${CPACK_PACKAGE_DESCRIPTION_SUMMARY}\n\n${license}")
file(REMOVE ${doc}/LICENSE)

string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(WRITE ${doc}/changelog "${CPACK_PACKAGE_NAME} (${CPACK_PACKAGE_VERSION}) unstable; urgency=medium

  * What has changed is told by CHANGELOG.md.

 -- ${CPACK_PACKAGE_CONTACT}  ${date}
")
foreach(file ${doc}/changelog ${usr}/share/man/man1/atrito.1 ${usr}/share/man/man1/atrito-lab.1)
   execute_process(COMMAND gzip --best --no-name ${file} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
