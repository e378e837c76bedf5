# install, export and pkg-config for whoever brings a renderer of their own: enf_core and its headers.

if(NOT TARGET enf_core)
  return()
endif()
include(CMakePackageConfigHelpers)

install(TARGETS enf_core EXPORT enfilade ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY engine/include/enfilade DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")
install(EXPORT enfilade NAMESPACE enfilade:: FILE enfiladeConfig.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/enfilade)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/enfiladeConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/enfiladeConfigVersion.cmake DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/enfilade)

configure_file(cmake/enfilade.pc.in ${CMAKE_BINARY_DIR}/enfilade.pc @ONLY)
install(FILES ${CMAKE_BINARY_DIR}/enfilade.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
