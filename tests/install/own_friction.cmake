# Installs what BINARY_DIR holds below FOLDER, builds contrib/examples/own_friction against the copy in a clean folder and
# runs its case.
# cmake -D BINARY_DIR=... -D SOURCE_DIR=... -D FOLDER=... -D BUILD_TYPE=... -P own_friction.cmake

include(${CMAKE_CURRENT_LIST_DIR}/run_or_fail.cmake)

file(REMOVE_RECURSE ${FOLDER})
run(${CMAKE_COMMAND} --install ${BINARY_DIR} --prefix ${FOLDER}/copy)
file(GLOB_RECURSE _configs ${FOLDER}/copy/*/nodusConfig.cmake)
get_filename_component(_package ${_configs} DIRECTORY)

file(COPY ${SOURCE_DIR}/contrib/examples/own_friction DESTINATION ${FOLDER})
run(${CMAKE_COMMAND} -S ${FOLDER}/own_friction -B ${FOLDER}/own_friction/build -Dnodus_DIR=${_package}
  -DCMAKE_BUILD_TYPE=${BUILD_TYPE})
run(${CMAKE_COMMAND} --build ${FOLDER}/own_friction/build)

file(COPY ${FOLDER}/own_friction/block.prm DESTINATION ${FOLDER}/own_friction/build)
set(_nodus ${CMAKE_COMMAND} -E chdir ${FOLDER} ${FOLDER}/copy/bin/nodus ${FOLDER}/own_friction/build/block.prm)
run(${_nodus} --check-law)
message("${log}")
run(${_nodus})
run(awk -F, -f ${CMAKE_CURRENT_LIST_DIR}/own_friction.awk ${FOLDER}/results/block/contact.csv)
message("${log}")
