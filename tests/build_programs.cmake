# Builds all test programs and forgets the results of earlier runs. cmake -D BINARY_DIR=... -D CORES=... -P build_programs.cmake
#
# deal.II's run_test.cmake keeps a file interrupt_guard.cc, a source of each program, in place while a test runs and
# renames it to interrupt_guard.cc_bck afterwards: one that is in place when a test starts tells of an interrupted test,
# is deleted, and the program is linked again. Programs that are built ahead have to leave the files as a finished test
# does.
file(GLOB_RECURSE interrupted ${BINARY_DIR}/tests/interrupt_guard.cc)
foreach(guard ${interrupted})
  file(REMOVE ${guard})
endforeach()
file(GLOB_RECURSE parked ${BINARY_DIR}/tests/interrupt_guard.cc_bck)
foreach(guard ${parked})
  string(REGEX REPLACE "_bck$" "" original ${guard})
  file(RENAME ${guard} ${original})
endforeach()

execute_process(COMMAND ${CMAKE_COMMAND} --build ${BINARY_DIR} --target test_programs --parallel ${CORES}
  RESULT_VARIABLE result)

file(GLOB_RECURSE guards ${BINARY_DIR}/tests/interrupt_guard.cc)
foreach(guard ${guards})
  file(RENAME ${guard} ${guard}_bck)
endforeach()

# A test is a file to ninja and would not be run again as long as its program stays the same.
file(GLOB_RECURSE outputs ${BINARY_DIR}/tests/output ${BINARY_DIR}/tests/diff)
if(outputs)
  file(REMOVE ${outputs})
endif()
if(result)
  message(FATAL_ERROR "the test programs do not build")
endif()
