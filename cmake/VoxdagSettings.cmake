# Compiler settings of every target of the project: C++20, warnings, sanitizers, unity builds.
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
# A unity build compiles several sources of a target as one, which takes a fraction of the time.
# `scripts/test.sh --tidy` builds without, and so finds includes that are missing.
if(PROJECT_IS_TOP_LEVEL)
  option(CMAKE_UNITY_BUILD "Compile several sources as one" ON)
  set(CMAKE_UNITY_BUILD_BATCH_SIZE 16)
endif()

if(CMAKE_CXX_BYTE_ORDER STREQUAL BIG_ENDIAN)
  message(FATAL_ERROR "voxdag: the processor ${CMAKE_SYSTEM_PROCESSOR} is big-endian, but voxdag maps files, whose numbers are "
                      "little-endian. include/voxdag.h, the reader in one header, works there (docs/reader.md)")
endif()

add_library(voxdag_settings INTERFACE)
# -ffp-contract=off: equal arithmetic, and so equal hits and bytes, on every machine.
# Without errno and traps, square roots and comparisons are single instructions; results are equal.
target_compile_options(voxdag_settings INTERFACE
  $<$<COMPILE_LANGUAGE:CXX>:-Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
    -ffp-contract=off -fno-math-errno -fno-trapping-math>)
# Highway compiles hot loops for SSE2, SSE4, AVX2 and AVX-512; almost all processors with SSSE3 have SSE4, too.
# SVE's vectors have no known length, so there are no arrays of them: NEON stands for all of ARM.
set(disabled_targets HWY_SSSE3)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "aarch64|arm64")
  set(disabled_targets "(HWY_SVE|HWY_SVE2|HWY_SVE_256|HWY_SVE2_128)")
  target_compile_options(voxdag_settings INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-Wno-psabi>)
endif()
target_compile_definitions(voxdag_settings INTERFACE "HWY_DISABLED_TARGETS=${disabled_targets}")
if(VOXDAG_WERROR)
  target_compile_options(voxdag_settings INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-Werror>)
endif()
if(VOXDAG_SANITIZE)
  add_compile_options("$<$<COMPILE_LANGUAGE:CXX>:-fsanitize=${VOXDAG_SANITIZE};-fno-omit-frame-pointer>")
  add_link_options(-fsanitize=${VOXDAG_SANITIZE})
endif()
# The Python module links the libraries.
set(VOXDAG_PIC ON)
if(EMSCRIPTEN)
  set(VOXDAG_PIC OFF)
  string(REPLACE "-O3" "-O2" CMAKE_CXX_FLAGS_RELEASE "${CMAKE_CXX_FLAGS_RELEASE}")
  # WebAssembly's own exceptions and vectors, and shared memory: Chromium 95, Firefox 100, Safari 16.4, Node 18 and later.
  add_compile_options(-fwasm-exceptions -msimd128 -pthread)
  foreach(language C CXX)
    string(APPEND CMAKE_${language}_FLAGS " --em-config ${PROJECT_SOURCE_DIR}/cmake/wasm/emscripten.config -Wno-version-check")
  endforeach()
  add_compile_options("$<$<COMPILE_LANGUAGE:CXX>:SHELL:-include ${PROJECT_SOURCE_DIR}/cmake/wasm/libcxx14.hpp>")
  # All threads have the stack of the first one. JavaScript looks again where memory is after it has grown; it has little to do.
  add_link_options(-fwasm-exceptions -pthread -sDEFAULT_PTHREAD_STACK_SIZE=5MB -Wno-pthreads-mem-growth)
endif()
