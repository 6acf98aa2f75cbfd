# cmake --install: the program, the library with its public headers, and what find_package(nodus) reads; cpack: a Debian
# package of the program.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# Programs find the shared libraries that nodus opens by itself beside them.
set(NODUS_MULTIGRID_FOLDER ${CMAKE_INSTALL_LIBDIR}/nodus)
file(RELATIVE_PATH _from_program ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR}/nodus)
set_target_properties(nodus PROPERTIES INSTALL_RPATH "$ORIGIN/${_from_program}")
if(NODUS_MULTIGRID_TARGETS)
  install(TARGETS ${NODUS_MULTIGRID_TARGETS} LIBRARY DESTINATION ${NODUS_MULTIGRID_FOLDER} COMPONENT program)
endif()

install(TARGETS nodus RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
install(TARGETS nodus_library nodus_plugin EXPORT nodus ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
install(DIRECTORY include/nodus DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)

set(_package ${CMAKE_INSTALL_LIBDIR}/cmake/nodus)
install(EXPORT nodus NAMESPACE nodus:: FILE nodusTargets.cmake DESTINATION ${_package} COMPONENT development)
string(TOUPPER ${CMAKE_BUILD_TYPE} NODUS_UPPER_BUILD_TYPE)
string(TOLOWER ${CMAKE_BUILD_TYPE} NODUS_LOWER_BUILD_TYPE)
configure_package_config_file(contrib/cmake/nodusConfig.cmake.in ${CMAKE_BINARY_DIR}/nodusConfig.cmake
  INSTALL_DESTINATION ${_package} PATH_VARS NODUS_MULTIGRID_FOLDER)
# Before 1.0 the interface may change with the second number.
write_basic_package_version_file(${CMAKE_BINARY_DIR}/nodusConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/nodusConfig.cmake ${CMAKE_BINARY_DIR}/nodusConfigVersion.cmake
  DESTINATION ${_package} COMPONENT development)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "nodus")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Frictional contact of 3D bodies at large deformation")
set(CPACK_COMPONENTS_ALL program)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME nodus)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
include(CPack)
