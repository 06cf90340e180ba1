# `cmake --install`: the command line, the headers, the static libraries and the package that
# find_package(voxdag CONFIG) finds. voxdag::voxdag is all parts; voxdag::trace and so on are one.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/voxdag)
get_property(parts GLOBAL PROPERTY VOXDAG_PARTS)

install(TARGETS voxdag ${parts} EXPORT voxdagTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
        INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT voxdagTargets NAMESPACE voxdag:: DESTINATION ${package_dir})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/src/voxdag DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
        FILES_MATCHING PATTERN "*.hpp")
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
if(VOXDAG_BUILD_APPS)
  install(TARGETS voxdag_app RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()

configure_package_config_file(
  ${PROJECT_SOURCE_DIR}/cmake/voxdagConfig.cmake.in ${PROJECT_BINARY_DIR}/voxdagConfig.cmake
  INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(
  ${PROJECT_BINARY_DIR}/voxdagConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/voxdagConfig.cmake ${PROJECT_BINARY_DIR}/voxdagConfigVersion.cmake
        DESTINATION ${package_dir})
