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

if("assimp" IN_LIST VOXDAG_LIBRARY_PACKAGES)
  find_package(assimp QUIET)
  if(NOT assimp_FOUND)
    message(STATUS "voxdag: assimp not found: voxdag reads OBJ, PLY, STL, OFF and glTF only")
  endif()
endif()

if("embree" IN_LIST VOXDAG_LIBRARY_PACKAGES)
  find_package(embree 3 QUIET)
  if(NOT embree_FOUND)
    message(STATUS "voxdag: Embree 3 (libembree-dev) not found: no `render --mesh`, no comparison with it in `bench trace`")
  endif()
endif()

if("OpenVDB" IN_LIST VOXDAG_LIBRARY_PACKAGES)
  find_package(OpenVDB QUIET)
  find_path(NanoVDB_INCLUDE_DIR nanovdb/util/OpenToNanoVDB.h)
  mark_as_advanced(NanoVDB_INCLUDE_DIR)
  if(NOT OpenVDB_FOUND)
    message(STATUS "voxdag: OpenVDB (libopenvdb-dev, libboost-dev) not found: voxdag reads no .vdb volumes")
  endif()
endif()

if("TIFF" IN_LIST VOXDAG_LIBRARY_PACKAGES)
  find_package(TIFF 4.5 QUIET)
  if(NOT TIFF_FOUND)
    message(STATUS "voxdag: libtiff 4.5 (libtiff-dev) not found: voxdag reads no stacks of TIFF")
  endif()
endif()

if("GDCM" IN_LIST VOXDAG_LIBRARY_PACKAGES)
  find_package(GDCM 3 QUIET)
  if(NOT GDCM_FOUND)
    message(STATUS "voxdag: GDCM 3 (libgdcm-dev) not found: voxdag reads no DICOM")
  endif()
endif()

if("MPI" IN_LIST VOXDAG_LIBRARY_PACKAGES)
  set(MPI_CXX_SKIP_MPICXX TRUE)  # MPI's old classes for C++
  find_package(MPI QUIET COMPONENTS CXX)
  if(NOT MPI_CXX_FOUND)
    message(STATUS "voxdag: MPI (libopenmpi-dev, openmpi-bin) not found: no builds under mpirun")
  endif()
endif()

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
