# Compiler settings of every target of the project: C++20, warnings, sanitizers.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()
find_program(VOXDAG_CCACHE ccache)
if(VOXDAG_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${VOXDAG_CCACHE})
endif()

add_library(voxdag_settings INTERFACE)
# -ffp-contract=off: equal arithmetic, and so equal hits and bytes, on every machine.
target_compile_options(voxdag_settings INTERFACE
  $<$<COMPILE_LANGUAGE:CXX>:-Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -ffp-contract=off>)
if(VOXDAG_WERROR)
  target_compile_options(voxdag_settings INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-Werror>)
endif()
if(VOXDAG_SANITIZE)
  add_compile_options("$<$<COMPILE_LANGUAGE:CXX>:-fsanitize=${VOXDAG_SANITIZE};-fno-omit-frame-pointer>")
  add_link_options(-fsanitize=${VOXDAG_SANITIZE})
endif()
