# Runs [LAUNCHER] NODUS on PRM with ARGUMENTS in the empty FOLDER; see CMakeLists.txt for what must come out.

file(REMOVE_RECURSE ${FOLDER})
file(MAKE_DIRECTORY ${FOLDER})
execute_process(COMMAND ${LAUNCHER} ${NODUS} ${PRM} ${ARGUMENTS}
  WORKING_DIRECTORY ${FOLDER}
  RESULT_VARIABLE code
  OUTPUT_VARIABLE screen
  ERROR_VARIABLE message)

# Messages must not depend on where the checkout lies.
get_filename_component(source_folder ${PRM} DIRECTORY)
string(REPLACE "${source_folder}/" "" message "${message}")

# ... nor on the machine.
string(REGEX REPLACE "more than the [0-9.e+]+ GB" "more than the N GB" message "${message}")

# ... nor on the versions at hand.
string(REGEX REPLACE
  "nodus [0-9.]+, deal.II [0-9.]+[-a-z0-9.]*(, (64-bit indices|libc\\+\\+|old ABI of libstdc\\+\\+|Debug|Release))*"
  "nodus N, deal.II N" message "${message}")

if(LAUNCHER)
  string(REGEX MATCHALL "nodus: [^\n]*\n" message "${message}")
  string(REPLACE ";nodus: " "nodus: " message "${message}")
endif()

if(NOT code STREQUAL "1")
  message(FATAL_ERROR "exit code ${code} instead of 1\n${screen}${message}")
endif()
file(GLOB left ${FOLDER}/*)
if(left)
  message(FATAL_ERROR "files were left behind: ${left}\n${message}")
endif()
file(WRITE ${FOLDER}.message "${message}")
execute_process(COMMAND ${CMAKE_COMMAND} -E compare_files ${FOLDER}.message ${EXPECTED} RESULT_VARIABLE differs)
if(differs)
  message(FATAL_ERROR "${EXPECTED} does not have the message:\n${message}")
endif()
