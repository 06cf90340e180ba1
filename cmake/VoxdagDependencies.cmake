# Every package comes from Debian 12. What is optional is found or skipped with one line.

# What the library links: an installed voxdag looks for the same packages (voxdagConfig.cmake.in).
set(VOXDAG_LIBRARY_PACKAGES
  Threads TBB hwy PNG JPEG OpenEXR nlohmann_json FastFloat)
foreach(package ${VOXDAG_LIBRARY_PACKAGES})
  if(package STREQUAL "OpenEXR")
    # Debian's Imath names a Python library of a package that nobody needs, at length.
    set(CMAKE_MESSAGE_LOG_LEVEL WARNING)
  endif()
  find_package(${package} REQUIRED)
  unset(CMAKE_MESSAGE_LOG_LEVEL)
endforeach()

find_package(assimp QUIET)
if(assimp_FOUND)
  list(APPEND VOXDAG_LIBRARY_PACKAGES assimp)
else()
  message(STATUS "voxdag: assimp not found: meshes other than OBJ, PLY, STL and glTF will be refused")
endif()

find_package(embree 3 QUIET)
if(embree_FOUND)
  list(APPEND VOXDAG_LIBRARY_PACKAGES embree)
else()
  message(STATUS "voxdag: Embree 3 (libembree-dev) not found: no `render --primary mesh`, no comparison with it in `bench trace`")
endif()

if(VOXDAG_BUILD_APPS)
  find_package(fmt REQUIRED)
  find_package(CLI11 REQUIRED)
endif()
