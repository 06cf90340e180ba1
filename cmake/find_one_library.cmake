# find_one_library(PACKAGE LIBRARY HEADER): for Find modules of packages of one library that Debian gives no
# module for CMake. Sets PACKAGE_FOUND, and defines PACKAGE::LIBRARY.
include(FindPackageHandleStandardArgs)
macro(find_one_library package library header)
  find_library(${package}_LIBRARY ${library})
  find_path(${package}_INCLUDE_DIR ${header})
  mark_as_advanced(${package}_LIBRARY ${package}_INCLUDE_DIR)
  find_package_handle_standard_args(${package} REQUIRED_VARS ${package}_LIBRARY ${package}_INCLUDE_DIR)
  if(${package}_FOUND AND NOT TARGET ${package}::${library})
    add_library(${package}::${library} UNKNOWN IMPORTED)
    set_target_properties(${package}::${library} PROPERTIES
      IMPORTED_LOCATION ${${package}_LIBRARY} INTERFACE_INCLUDE_DIRECTORIES ${${package}_INCLUDE_DIR})
  endif()
endmacro()
