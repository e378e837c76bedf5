# install, export and pkg-config for whoever brings a renderer of their own: enf_core and its headers, the
# component "core". tests/install proves it.

if(NOT TARGET enf_core)
  return()
endif()
include(CMakePackageConfigHelpers)

install(TARGETS enf_core EXPORT enfilade ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT core)
install(DIRECTORY engine/include/enfilade DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT core
        FILES_MATCHING PATTERN "*.h")
install(EXPORT enfilade NAMESPACE enfilade:: FILE enfiladeConfig.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/enfilade COMPONENT core)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/enfiladeConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/enfiladeConfigVersion.cmake DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/enfilade
        COMPONENT core)

configure_file(cmake/enfilade.pc.in ${CMAKE_BINARY_DIR}/enfilade.pc @ONLY)
install(FILES ${CMAKE_BINARY_DIR}/enfilade.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT core)
