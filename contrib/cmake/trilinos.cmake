# Multigrid of Trilinos: a shared library for each of its packages that is installed. The program opens the one that a
# case names (Linear solver / Preconditioner) and is linked to none. A package that is not there, as ML where there is
# no Epetra, leaves its library out. NODUS_MULTIGRIDS lists what is built, by the names in the parameter file.
include(CheckCXXSourceCompiles)
option(NODUS_TRILINOS "Build preconditioners of Trilinos, ML and MueLu, where these are installed" ON)
set(NODUS_MULTIGRIDS)
set(NODUS_MULTIGRID_TARGETS)

# Programs look where they are linked to look: those of tests in the build folder, nodus in its own. Where copies look
# that cmake --install makes is in install.cmake.
set(CMAKE_BUILD_RPATH ${CMAKE_BINARY_DIR})

# add_multigrid(<name> <header> <libraries that its source needs>... [OPTIONAL <those that not every version has>...])
function(add_multigrid name header)
  cmake_parse_arguments(PARSE_ARGV 2 _of "" "" OPTIONAL)
  string(TOLOWER ${name} _lower)
  set(_hints HINTS ${TRILINOS_DIR} $ENV{TRILINOS_DIR})
  find_path(NODUS_${name}_HEADERS ${header} ${_hints} PATH_SUFFIXES include/trilinos trilinos include)
  mark_as_advanced(NODUS_${name}_HEADERS)
  set(_libraries)
  foreach(_library ${_of_UNPARSED_ARGUMENTS} ${_of_OPTIONAL})
    find_library(NODUS_${_library}_LIBRARY NAMES trilinos_${_library} ${_library} ${_hints} PATH_SUFFIXES lib)
    mark_as_advanced(NODUS_${_library}_LIBRARY)
    if(NODUS_${_library}_LIBRARY OR NOT _library IN_LIST _of_OPTIONAL)
      list(APPEND _libraries ${NODUS_${_library}_LIBRARY})
    endif()
  endforeach()
  if(NOT "${NODUS_${name}_HEADERS};${_libraries}" MATCHES "NOTFOUND")
    # headers of one package include those of others, which may be missing
    set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
    set(CMAKE_REQUIRED_INCLUDES ${NODUS_${name}_HEADERS} ${DEAL_II_INCLUDE_DIRS})
    if(TARGET dealii::dealii_release)
      set(CMAKE_REQUIRED_LIBRARIES dealii::dealii_release)
    endif()
    check_cxx_source_compiles("#include <${header}>\nint main() {}" NODUS_${name}_COMPILES)
  endif()
  if(NOT NODUS_${name}_COMPILES)
    message(STATUS "Preconditioner ${name} is left out: libtrilinos-${_lower}-dev is not complete here")
    return()
  endif()
  set(_target nodus_${_lower})
  add_library(${_target} MODULE source/solve/trilinos/${_lower}.cc)
  deal_ii_setup_target(${_target})
  target_include_directories(${_target} PRIVATE ${CMAKE_SOURCE_DIR}/source)
  target_include_directories(${_target} SYSTEM PRIVATE ${NODUS_${name}_HEADERS})
  target_link_libraries(${_target} ${_libraries})
  # newer headers of Epetra warn of themselves
  target_compile_options(${_target} PRIVATE -Wall -Wextra -Wpedantic -Wno-cpp $<$<CONFIG:Release>:-g0>)
  set_target_properties(${_target} PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})
  set(NODUS_MULTIGRIDS ${NODUS_MULTIGRIDS} ${name} PARENT_SCOPE)
  set(NODUS_MULTIGRID_TARGETS ${NODUS_MULTIGRID_TARGETS} ${_target} PARENT_SCOPE)
endfunction()

if(NODUS_TRILINOS)
  add_multigrid(ML ml_MultiLevelPreconditioner.h ml epetra teuchosparameterlist teuchoscore)
  add_multigrid(MueLu MueLu_CreateTpetraPreconditioner.hpp
    muelu xpetra tpetra teuchoscomm teuchosparameterlist teuchoscore kokkoscore
    OPTIONAL muelu-interface xpetra-sup) # up to Trilinos 15
endif()
