# Installs what BINARY_DIR holds below FOLDER, builds contrib/examples/own_material against the copy in a clean folder, runs
# its case with the installed nodus, and compares with nodus's own law in a program that is linked to the copy.
# cmake -D BINARY_DIR=... -D SOURCE_DIR=... -D FOLDER=... -D BUILD_TYPE=... -P own_material.cmake

include(${CMAKE_CURRENT_LIST_DIR}/run_or_fail.cmake)

file(REMOVE_RECURSE ${FOLDER})
run(${CMAKE_COMMAND} --install ${BINARY_DIR} --prefix ${FOLDER}/copy)
file(GLOB_RECURSE _configs ${FOLDER}/copy/*/nodusConfig.cmake)
get_filename_component(_package ${_configs} DIRECTORY)

file(COPY ${SOURCE_DIR}/contrib/examples/own_material DESTINATION ${FOLDER})
file(COPY ${CMAKE_CURRENT_LIST_DIR}/compare_laws DESTINATION ${FOLDER})
foreach(_project own_material compare_laws)
  run(${CMAKE_COMMAND} -S ${FOLDER}/${_project} -B ${FOLDER}/${_project}/build -Dnodus_DIR=${_package}
    -DCMAKE_BUILD_TYPE=${BUILD_TYPE})
  run(${CMAKE_COMMAND} --build ${FOLDER}/${_project}/build)
endforeach()

file(COPY ${FOLDER}/own_material/block.prm DESTINATION ${FOLDER}/own_material/build)
set(_case ${FOLDER}/own_material/build/block.prm)
set(_nodus ${CMAKE_COMMAND} -E chdir ${FOLDER} ${FOLDER}/copy/bin/nodus ${_case})
run(${_nodus} --check-law)
run(${_nodus} --explain "Gent")
string(REGEX MATCH "Value Jm[^\n]*" _meaning "${log}")
message("${_meaning}")
run(${_nodus} --set "Load stepping/Increments=2")
run(${CMAKE_COMMAND} -E chdir ${FOLDER} ${FOLDER}/compare_laws/build/compare_laws ${_case})
message("${log}")
