# voxdag_optimize(-O1|-O2 TARGET ...) compiles targets of a Release build with less than CMake's -O3, which
# takes a sixth to a third less time: for what waits for files and people, and has no hot loops.
function(voxdag_optimize level)
  if(EMSCRIPTEN AND level STREQUAL -O1)
    set(level -Os)  # a page loads it first
  endif()
  foreach(target ${ARGN})
    target_compile_options(${target} PRIVATE $<$<AND:$<CONFIG:Release>,$<COMPILE_LANGUAGE:CXX>>:${level}>)
  endforeach()
endfunction()

# voxdag_library(ROOM [LINK voxdag_OTHER ... external::target ...] [PRIVATE_LINK ...] [LEAVE_OUT a.cpp ...]
#                [ALONE b.cpp ...] [NOT_HOT])
# adds the target voxdag_ROOM: all sources of a folder of src/voxdag but those to leave out, which
# modules have. A room without sources is header-only. A unity build compiles the sources in ALONE by
# themselves: those that Highway compiles once per instruction set. NOT_HOT: see voxdag_optimize.
function(voxdag_library name)
  cmake_parse_arguments(ARG "NOT_HOT" "" "LINK;PRIVATE_LINK;LEAVE_OUT;ALONE" ${ARGN})
  set(target voxdag_${name})
  file(GLOB_RECURSE sources RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} CONFIGURE_DEPENDS *.cpp)
  if(ARG_LEAVE_OUT)
    list(REMOVE_ITEM sources ${ARG_LEAVE_OUT})
  endif()
  if(sources)
    add_library(${target} STATIC ${sources})
    set(scope PUBLIC)
    target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:voxdag_settings> ${ARG_PRIVATE_LINK})
    set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ${VOXDAG_PIC})
    set_source_files_properties(${ARG_ALONE} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    if(ARG_NOT_HOT)
      voxdag_optimize(-O2 ${target})
    endif()
  else()
    add_library(${target} INTERFACE)
    set(scope INTERFACE)
  endif()
  add_library(voxdag::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  target_compile_features(${target} ${scope} cxx_std_20)
  target_include_directories(${target} ${scope}
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src> $<INSTALL_INTERFACE:include>)
  target_link_libraries(${target} ${scope} ${ARG_LINK})
  set_property(GLOBAL APPEND PROPERTY VOXDAG_TARGETS ${target})
endfunction()

# voxdag_module(TARGET SOURCES ... LINK ...) adds a module that programs load on demand.
function(voxdag_module target)
  cmake_parse_arguments(ARG "" "" "LINK" ${ARGN})
  add_library(${target} MODULE ${ARG_UNPARSED_ARGUMENTS})
  set_target_properties(${target} PROPERTIES PREFIX "" LIBRARY_OUTPUT_DIRECTORY ${VOXDAG_MODULES})
  target_link_libraries(${target} PRIVATE voxdag_settings ${ARG_LINK})
endfunction()
