# Compiles the headers that most sources include once, instead of once for each source. The build
# under clang does without, and so finds includes that are missing.
set(precompile_by_default OFF)
if(PROJECT_IS_TOP_LEVEL AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  set(precompile_by_default ON)
endif()
option(VOXDAG_PRECOMPILE "Precompile the headers of the standard library and of TBB" ${precompile_by_default})

# voxdag_precompiled_headers(NAME header ...) adds a target whose headers others can use.
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

# Lets a target use the precompiled headers of its kind, or those of the target `headers`: a compiler
# reads only those that it wrote with the same options.
function(voxdag_precompile target)
  if(NOT VOXDAG_PRECOMPILE)
    return()
  endif()
  get_target_property(is_pic ${target} POSITION_INDEPENDENT_CODE)
  set(headers voxdag_program_headers)
  if(ARGN)
    set(headers ${ARGN})
  elseif(is_pic)
    set(headers voxdag_library_headers)
  endif()
  target_precompile_headers(${target} REUSE_FROM ${headers})
  # g++ 12 forgets which of these headers are the system's, and warns of std::string. The preset odr
  # builds without them, and so keeps the warnings.
  target_compile_options(${target} PRIVATE
    "$<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-array-bounds;-Wno-restrict;-Wno-stringop-overflow;-Wno-stringop-overread>")
endfunction()

if(VOXDAG_PRECOMPILE)
  voxdag_precompiled_headers(voxdag_library_headers)
  set_target_properties(voxdag_library_headers PROPERTIES POSITION_INDEPENDENT_CODE ON)
  voxdag_precompiled_headers(voxdag_program_headers)
endif()
