# A python3 with numpy for some of the tests: the one of build/venv, else that of the path. Sets ATRITO_NUMPY_PYTHON where there is one.
include_guard()

set(ATRITO_NUMPY_PYTHON)
find_program(system_python python3 NO_CACHE)
foreach(python ${PROJECT_SOURCE_DIR}/build/venv/bin/python3 ${system_python})
   if(NOT ATRITO_NUMPY_PYTHON AND EXISTS ${python})
      execute_process(COMMAND ${python} -c "import numpy" RESULT_VARIABLE no_numpy OUTPUT_QUIET ERROR_QUIET)
      if(no_numpy EQUAL 0)
         set(ATRITO_NUMPY_PYTHON ${python})
      endif()
   endif()
endforeach()
