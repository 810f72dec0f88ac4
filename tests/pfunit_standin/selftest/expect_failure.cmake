# cmake -DCOMMAND=<program;arguments> -DOUTPUT=<regular expression> [-DABSENT=<file>] -P expect_failure.cmake
# Passes if the command fails with an exit status of its own (not a signal), says what is expected,
# and leaves no file ABSENT behind.
if(ABSENT)
   file(REMOVE ${ABSENT})
endif()
execute_process(COMMAND ${COMMAND} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(NOT status MATCHES "^[12]$")
   message(FATAL_ERROR "exit status 1 or 2 expected, found '${status}' with\n${output}")
endif()
if(NOT output MATCHES "${OUTPUT}")
   message(FATAL_ERROR "expected in the output: ${OUTPUT}\nfound\n${output}")
endif()
if(ABSENT AND EXISTS "${ABSENT}")
   message(FATAL_ERROR "the refused file was translated all the same: ${ABSENT}")
endif()
