# run(<command> <arguments>...): leaves what it prints in log, ends with it where the exit code is not 0.
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE _code OUTPUT_VARIABLE _log ERROR_VARIABLE _log)
  if(NOT _code EQUAL 0)
    message(FATAL_ERROR "${_log}\nexit code ${_code}: ${ARGN}")
  endif()
  set(log "${_log}" PARENT_SCOPE)
endfunction()
