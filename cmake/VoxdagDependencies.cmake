# Finds the packages of the parts that are built. All packages are in Debian 12. If an optional
# package is missing, one line says so.
set(optional_packages assimp embree OpenVDB TIFF GDCM MPI CUDAToolkit)  # CUDAToolkit: cmake/VoxdagCuda.cmake

# The packages that an installed voxdag needs, by part: voxdagConfig.cmake.in reads them.
set(VOXDAG_LIBRARY_PACKAGES Threads)
foreach(room ${VOXDAG_ROOMS})
  list(APPEND VOXDAG_LIBRARY_PACKAGES ${VOXDAG_ROOM_${room}_PACKAGES})
endforeach()
list(REMOVE_DUPLICATES VOXDAG_LIBRARY_PACKAGES)

foreach(package ${VOXDAG_LIBRARY_PACKAGES})
  if(package IN_LIST optional_packages)
    continue()
  endif()
  if(package STREQUAL "OpenEXR")
    # Debian's Imath prints a paragraph about a Python library that voxdag does not use.
    set(CMAKE_MESSAGE_LOG_LEVEL WARNING)
  endif()
  find_package(${package} REQUIRED)
  unset(CMAKE_MESSAGE_LOG_LEVEL)
endforeach()

find_path(VOXDAG_STB_INCLUDE stb/stb_image.h REQUIRED)  # only headers
mark_as_advanced(VOXDAG_STB_INCLUDE)

# find_optional(PACKAGE MISSING ...) finds a package that a room may do without, with more arguments of find_package.
# MISSING says what is left out.
macro(find_optional package missing)
  if("${package}" IN_LIST VOXDAG_LIBRARY_PACKAGES)
    find_package(${package} QUIET ${ARGN})
    if(NOT ${package}_FOUND)
      message(STATUS "voxdag: ${missing}")
    endif()
  endif()
endmacro()
find_optional(assimp "assimp not found: voxdag reads OBJ, PLY, STL, OFF and glTF only")
find_optional(embree "Embree 3 (libembree-dev) not found: no `render --mesh`, no comparison with it in `bench trace`" 3)
find_optional(OpenVDB "OpenVDB (libopenvdb-dev, libboost-dev) not found: voxdag reads no .vdb volumes")
find_path(NanoVDB_INCLUDE_DIR nanovdb/util/OpenToNanoVDB.h)
mark_as_advanced(NanoVDB_INCLUDE_DIR)
find_optional(TIFF "libtiff 4.5 (libtiff-dev) not found: voxdag reads no stacks of TIFF" 4.5)
find_optional(GDCM "GDCM 3 (libgdcm-dev) not found: voxdag reads no DICOM" 3)
set(MPI_CXX_SKIP_MPICXX TRUE)  # MPI's old classes for C++
find_optional(MPI "MPI (libopenmpi-dev, openmpi-bin) not found: no builds under mpirun" COMPONENTS CXX)

if(VOXDAG_BUILD_APPS)
  find_package(CLI11 REQUIRED)
endif()

if(VOXDAG_BUILD_APPS AND VOXDAG_VIEW_SERVER)
  # Debian's cpp-httplib has no CMake package. Its library is built with TLS and compression, which
  # its headers must know. Later versions have other functions for subclasses.
  find_path(VOXDAG_HTTPLIB_INCLUDE httplib.h)
  find_library(VOXDAG_HTTPLIB_LIBRARY cpp-httplib)
  if(VOXDAG_HTTPLIB_INCLUDE AND VOXDAG_HTTPLIB_LIBRARY)
    file(STRINGS ${VOXDAG_HTTPLIB_INCLUDE}/httplib.h httplib_version REGEX "define CPPHTTPLIB_VERSION \"0\\.11\\.")
  endif()
  if(httplib_version)
    set(httplib_FOUND TRUE)
    add_library(httplib::httplib INTERFACE IMPORTED)
    target_include_directories(httplib::httplib INTERFACE ${VOXDAG_HTTPLIB_INCLUDE})
    target_compile_definitions(httplib::httplib INTERFACE
      CPPHTTPLIB_OPENSSL_SUPPORT CPPHTTPLIB_ZLIB_SUPPORT CPPHTTPLIB_BROTLI_SUPPORT)
    target_link_libraries(httplib::httplib INTERFACE ${VOXDAG_HTTPLIB_LIBRARY})
  else()
    message(STATUS "voxdag: cpp-httplib 0.11 (libcpp-httplib-dev) not found: no `voxdag view`")
  endif()
endif()
