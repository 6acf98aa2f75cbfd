# What NODUS prints with ARGUMENTS must be the file EXPECTED.

execute_process(COMMAND ${NODUS} ${ARGUMENTS} RESULT_VARIABLE code OUTPUT_VARIABLE printed)
file(READ ${EXPECTED} expected)
if(NOT code EQUAL 0)
  message(FATAL_ERROR "exit code ${code}")
endif()
if(NOT printed STREQUAL expected)
  message(FATAL_ERROR "${EXPECTED} is out of date: write it again with nodus ${ARGUMENTS}")
endif()
