# The target `docs`: Doxygen writes the reference of the public headers, and fails on a warning.
find_program(VOXDAG_DOXYGEN doxygen)
if(NOT VOXDAG_DOXYGEN)
  message(STATUS "Doxygen was not found: there is no target docs")
  return()
endif()

set(reference ${PROJECT_BINARY_DIR}/reference)
file(STRINGS ${PROJECT_SOURCE_DIR}/cmake/public_headers.txt headers REGEX "^[a-z]")
list(TRANSFORM headers PREPEND ${PROJECT_SOURCE_DIR}/src/voxdag/)
list(JOIN headers " \\\n  " inputs)
file(WRITE ${PROJECT_BINARY_DIR}/Doxyfile
  "@INCLUDE = ${PROJECT_SOURCE_DIR}/docs/Doxyfile\n"
  "PROJECT_NUMBER = ${PROJECT_VERSION}\n"
  "OUTPUT_DIRECTORY = ${reference}\n"
  "STRIP_FROM_PATH = ${PROJECT_SOURCE_DIR}/src\n"
  "USE_MDFILE_AS_MAINPAGE = ${PROJECT_SOURCE_DIR}/docs/api.md\n"
  "INPUT = ${PROJECT_SOURCE_DIR}/docs/api.md \\\n  ${inputs}\n")
file(MAKE_DIRECTORY ${reference})
add_custom_target(docs
  COMMAND ${VOXDAG_DOXYGEN} ${PROJECT_BINARY_DIR}/Doxyfile
  COMMAND ${CMAKE_COMMAND} -E echo "The reference: ${reference}/html/index.html"
  VERBATIM)
