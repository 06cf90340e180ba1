# `cmake --install` installs the command line, the public headers, the static libraries and the
# package that find_package(voxdag CONFIG) finds. voxdag::voxdag is all parts; voxdag::trace and so
# on are one part each. Components: `program`, `dev` and `python`.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/voxdag)
get_property(parts GLOBAL PROPERTY VOXDAG_TARGETS)

# The table of parts for voxdagConfig.cmake.
set(VOXDAG_ROOM_TABLE "")
foreach(room ${VOXDAG_ROOMS})
  set(packages ${VOXDAG_ROOM_${room}_PACKAGES})
  list(REMOVE_ITEM packages OpenVDB TIFF GDCM MPI)  # only modules link them
  foreach(optional assimp embree CUDAToolkit)
    if(NOT ${optional}_FOUND)
      list(REMOVE_ITEM packages ${optional})
    endif()
  endforeach()
  string(APPEND VOXDAG_ROOM_TABLE "set(voxdag_${room}_rooms ${VOXDAG_ROOM_${room}_ROOMS})\n"
                                  "set(voxdag_${room}_packages ${packages})\n")
endforeach()

install(TARGETS voxdag ${parts} EXPORT voxdagTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev
        INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT voxdagTargets NAMESPACE voxdag:: DESTINATION ${package_dir} COMPONENT dev)
# Installs the public headers and the headers that they include; no others.
install(CODE "
  set(LIST \"${PROJECT_SOURCE_DIR}/cmake/public_headers.txt\")
  set(SOURCE \"${PROJECT_SOURCE_DIR}/src\")
  set(ROOMS \"${VOXDAG_ROOMS}\")
  set(STAGE \"${PROJECT_BINARY_DIR}/installed_headers\")
  include(\"${PROJECT_SOURCE_DIR}/cmake/InstallHeaders.cmake\")" COMPONENT dev)
install(DIRECTORY ${PROJECT_BINARY_DIR}/installed_headers/voxdag DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT dev)
# The reader in one header, for programs without the library.
install(FILES ${PROJECT_SOURCE_DIR}/include/voxdag.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT dev)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/shaders DESTINATION ${CMAKE_INSTALL_DATADIR}/voxdag COMPONENT dev)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
foreach(module voxdag_vdb voxdag_vdb_export voxdag_tiff voxdag_dicom voxdag_mpi)
  if(TARGET ${module})
    install(TARGETS ${module} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/voxdag COMPONENT program)
  endif()
endforeach()
if(VOXDAG_BUILD_APPS)
  install(TARGETS voxdag_app RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
endif()

configure_package_config_file(
  ${PROJECT_SOURCE_DIR}/cmake/voxdagConfig.cmake.in ${PROJECT_BINARY_DIR}/voxdagConfig.cmake
  INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(
  ${PROJECT_BINARY_DIR}/voxdagConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/voxdagConfig.cmake ${PROJECT_BINARY_DIR}/voxdagConfigVersion.cmake
              cmake/FindWebP.cmake cmake/Findminizip.cmake cmake/Findzstd.cmake cmake/find_one_library.cmake
        DESTINATION ${package_dir} COMPONENT dev)

# scripts/release.sh makes Debian's packages: voxdag, voxdag-dev and python3-voxdag. It puts the man page and
# the completion into the build's folder `share`.
install(DIRECTORY ${PROJECT_BINARY_DIR}/share/ DESTINATION share COMPONENT program OPTIONAL)
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME voxdag)
set(CPACK_PACKAGE_CONTACT "The developers of voxdag")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL program dev)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# The program finds the modules by its RPATH, which dpkg-shlibdeps does not know.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${VOXDAG_MODULES})
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME voxdag)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_DEV_PACKAGE_NAME voxdag-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "${VOXDAG_DEV_PACKAGES}")
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "The command line program, and the modules that it loads.")
set(CPACK_COMPONENT_DEV_DESCRIPTION "The public headers and static libraries.")
if(VOXDAG_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-voxdag)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= 3.11), python3 (<< 3.12), python3-numpy")
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION "The Python module.")
endif()
include(CPack)
