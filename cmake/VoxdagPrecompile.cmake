# Compiles the headers that most sources include once, instead of once for each source. clang builds
# the library without them, and so finds includes that are missing.
set(precompile_by_default OFF)
if(PROJECT_IS_TOP_LEVEL AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  set(precompile_by_default ON)
endif()
option(VOXDAG_PRECOMPILE "Precompile the headers of the standard library and of TBB" ${precompile_by_default})

# voxdag_precompiled_headers(NAME [header ...]) adds the target NAME, which precompiles the common
# headers and those that are named.
function(voxdag_precompiled_headers name)
  file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp CONTENT "// Only its precompiled headers are used.\n")
  add_library(${name} OBJECT ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp)
  target_link_libraries(${name} PRIVATE voxdag_settings)
  target_precompile_headers(${name} PRIVATE
    <algorithm> <array> <atomic> <cmath> <cstdint> <cstring> <exception> <filesystem> <fstream>
    <functional> <iostream> <map> <memory> <mutex> <numeric> <optional> <set> <span> <sstream>
    <string> <string_view> <thread> <unordered_map> <utility> <variant> <vector>
    <tbb/enumerable_thread_specific.h> <tbb/parallel_for.h> <tbb/task_arena.h> ${ARGN})
endfunction()

# voxdag_precompile(TARGET HEADERS) lets a target use the precompiled headers of the target HEADERS.
# The compiler reads only headers that it precompiled with the options of the source.
function(voxdag_precompile target headers)
  if(NOT VOXDAG_PRECOMPILE)
    return()
  endif()
  target_precompile_headers(${target} REUSE_FROM ${headers})
  if(NOT headers STREQUAL voxdag_library_headers)
    # g++ 12 forgets which of these headers are the system's, and in programs and tests gives false
    # warnings of std::string.
    target_compile_options(${target} PRIVATE
      "$<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-array-bounds;-Wno-restrict;-Wno-stringop-overflow;-Wno-stringop-overread>")
  endif()
endfunction()

if(VOXDAG_PRECOMPILE)
  voxdag_precompiled_headers(voxdag_library_headers)
  set_target_properties(voxdag_library_headers PROPERTIES POSITION_INDEPENDENT_CODE ON)
  voxdag_precompiled_headers(voxdag_program_headers)
endif()
