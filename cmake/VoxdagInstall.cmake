# `cmake --install` installs the command line, the public headers, the static libraries and the
# package that find_package(voxdag CONFIG) finds. voxdag::voxdag is all parts; voxdag::trace and so
# on are one part each.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/voxdag)
get_property(parts GLOBAL PROPERTY VOXDAG_TARGETS)

# The table of parts for voxdagConfig.cmake.
set(VOXDAG_ROOM_TABLE "")
foreach(room ${VOXDAG_ROOMS})
  set(packages ${VOXDAG_ROOM_${room}_PACKAGES})
  list(REMOVE_ITEM packages OpenVDB MPI)  # only modules link them
  foreach(optional assimp embree CUDAToolkit)
    if(NOT ${optional}_FOUND)
      list(REMOVE_ITEM packages ${optional})
    endif()
  endforeach()
  string(APPEND VOXDAG_ROOM_TABLE "set(voxdag_${room}_rooms ${VOXDAG_ROOM_${room}_ROOMS})\n"
                                  "set(voxdag_${room}_packages ${packages})\n")
endforeach()

install(TARGETS voxdag ${parts} EXPORT voxdagTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
        INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT voxdagTargets NAMESPACE voxdag:: DESTINATION ${package_dir})
# Installs the public headers and the headers that they include; no others.
install(CODE "
  set(LIST \"${PROJECT_SOURCE_DIR}/cmake/public_headers.txt\")
  set(SOURCE \"${PROJECT_SOURCE_DIR}/src\")
  set(ROOMS \"${VOXDAG_ROOMS}\")
  set(STAGE \"${PROJECT_BINARY_DIR}/installed_headers\")
  include(\"${PROJECT_SOURCE_DIR}/cmake/InstallHeaders.cmake\")")
install(DIRECTORY ${PROJECT_BINARY_DIR}/installed_headers/voxdag DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
# The reader in one header, for programs without the library.
install(FILES ${PROJECT_SOURCE_DIR}/include/voxdag.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
foreach(module voxdag_vdb voxdag_vdb_export voxdag_mpi)
  if(TARGET ${module})
    install(TARGETS ${module} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/voxdag)
  endif()
endforeach()
if(VOXDAG_BUILD_APPS)
  install(TARGETS voxdag_app RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()

configure_package_config_file(
  ${PROJECT_SOURCE_DIR}/cmake/voxdagConfig.cmake.in ${PROJECT_BINARY_DIR}/voxdagConfig.cmake
  INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(
  ${PROJECT_BINARY_DIR}/voxdagConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/voxdagConfig.cmake ${PROJECT_BINARY_DIR}/voxdagConfigVersion.cmake
              cmake/FindWebP.cmake cmake/Findminizip.cmake cmake/Findzstd.cmake cmake/find_one_library.cmake
        DESTINATION ${package_dir})
