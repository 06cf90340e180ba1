# Finds GDCM's parts that read images. Sets GDCM_FOUND, and defines GDCM::images. GDCM's own package
# asks for many more libraries.
find_path(GDCM_INCLUDE_DIR gdcmImageReader.h PATH_SUFFIXES gdcm-3.0)
set(GDCM_LIBRARIES "")
foreach(part MSFF DSED DICT Common)
  find_library(GDCM_${part}_LIBRARY gdcm${part})
  mark_as_advanced(GDCM_${part}_LIBRARY)
  list(APPEND GDCM_LIBRARIES ${GDCM_${part}_LIBRARY})
endforeach()
mark_as_advanced(GDCM_INCLUDE_DIR)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(GDCM REQUIRED_VARS GDCM_MSFF_LIBRARY GDCM_DSED_LIBRARY GDCM_DICT_LIBRARY GDCM_Common_LIBRARY GDCM_INCLUDE_DIR)
if(GDCM_FOUND AND NOT TARGET GDCM::images)
  add_library(GDCM::images INTERFACE IMPORTED)
  set_target_properties(GDCM::images PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES ${GDCM_INCLUDE_DIR}
    INTERFACE_LINK_LIBRARIES "${GDCM_LIBRARIES}")
endif()
