# Finds OpenVDB and the headers of Boost that it includes. Sets OpenVDB_FOUND, and defines
# OpenVDB::openvdb. OpenVDB's own module asks for many more libraries.
find_library(OpenVDB_LIBRARY openvdb)
find_path(OpenVDB_INCLUDE_DIR openvdb/openvdb.h)
find_path(OpenVDB_BOOST_INCLUDE_DIR boost/numeric/conversion/conversion_traits.hpp)
mark_as_advanced(OpenVDB_LIBRARY OpenVDB_INCLUDE_DIR OpenVDB_BOOST_INCLUDE_DIR)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenVDB
  REQUIRED_VARS OpenVDB_LIBRARY OpenVDB_INCLUDE_DIR OpenVDB_BOOST_INCLUDE_DIR)
if(OpenVDB_FOUND AND NOT TARGET OpenVDB::openvdb)
  find_package(TBB REQUIRED)
  add_library(OpenVDB::openvdb UNKNOWN IMPORTED)
  set_target_properties(OpenVDB::openvdb PROPERTIES
    IMPORTED_LOCATION ${OpenVDB_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES "${OpenVDB_INCLUDE_DIR};${OpenVDB_BOOST_INCLUDE_DIR}"
    INTERFACE_LINK_LIBRARIES TBB::tbb)
endif()
