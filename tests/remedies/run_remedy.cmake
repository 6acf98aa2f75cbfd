# Runs CASE with NODUS in FOLDER twice, with the keys SETS: it must finish by way of REMEDY, and fail without it.
# Prints what was tried and the message of the failure.

file(REMOVE_RECURSE ${FOLDER})
set(prm ${CASE})
if(CASE MATCHES "^random ([0-9]+) ([0-9]+)$")
  # the Python of Debian, which has numpy
  execute_process(COMMAND ${CMAKE_COMMAND} -E env NODUS_STUDIES=${FOLDER}
    /usr/bin/python3 ${RANDOM_CASES} --seed ${CMAKE_MATCH_1} --only ${CMAKE_MATCH_2} --write
    RESULT_VARIABLE code OUTPUT_VARIABLE prm OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "random_cases.py ended with ${code}; contrib/install-dependencies installs what it needs")
  endif()
endif()

function(run code log)
  set(keys)
  foreach(_key ${SETS} ${ARGN})
    list(APPEND keys --set ${_key})
  endforeach()
  file(REMOVE_RECURSE ${FOLDER}/results)
  execute_process(COMMAND ${NODUS} ${prm} --set "Output/Results folder=${FOLDER}/results" ${keys}
    RESULT_VARIABLE _code OUTPUT_VARIABLE _log ERROR_VARIABLE _log)
  set(${code} ${_code} PARENT_SCOPE)
  set(${log} "${_log}" PARENT_SCOPE)
endfunction()

set(without ${REMEDY})
set(others)
if(ALSO)
  set(without "${ALSO},${REMEDY}")
  set(others "Strategy/Without=${ALSO}")
endif()

run(code log ${others})
if(NOT code EQUAL 0)
  message(FATAL_ERROR "${log}\nnodus ended with exit code ${code}")
endif()
string(REGEX MATCH "Tried where something failed, times: [^\n]*" tried "${log}")
message("${tried}")
if(NOT tried MATCHES "[:,] ${REMEDY} [0-9]")
  message(FATAL_ERROR "'${REMEDY}' was not used")
endif()

run(code log "Strategy/Without=${without}")
string(REGEX MATCH "nodus: no solution: [^\n]*" reason "${log}")
message("without '${REMEDY}': exit code ${code}, ${reason}")
if(NOT code EQUAL 1 OR reason STREQUAL "")
  message(FATAL_ERROR "${log}\nthe case was to fail without '${REMEDY}'")
endif()
