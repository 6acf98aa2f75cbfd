# Runs the case PRM with NODUS in FOLDER and compares the results with the `# Check:` lines of the case (prm/README.md).

file(REMOVE_RECURSE ${FOLDER})
execute_process(COMMAND ${NODUS} ${PRM} --set "Output/Results folder=${FOLDER}"
  RESULT_VARIABLE code OUTPUT_VARIABLE log ERROR_VARIABLE log)
if(NOT code EQUAL 0)
  message(FATAL_ERROR "${log}\nnodus ended with exit code ${code}")
endif()
execute_process(COMMAND ${COMPARE} ${PRM} ${FOLDER} RESULT_VARIABLE code OUTPUT_VARIABLE table ERROR_VARIABLE table)
message("${table}")
if(NOT code EQUAL 0 OR NOT table MATCHES "met, ")
  message(FATAL_ERROR "a reference of ${PRM} is not met, or there is none")
endif()
