# Sets VOXDAG_HAS_CUDA if nvcc was found, and enables CUDA as a language. Without nvcc,
# src/voxdag/cuda reports that there is no device.
set(VOXDAG_HAS_CUDA OFF)
if(VOXDAG_CUDA AND "cuda" IN_LIST VOXDAG_ROOMS)
  find_program(VOXDAG_NVCC nvcc HINTS ENV CUDA_PATH PATHS /usr/local/cuda/bin)
  if(VOXDAG_NVCC)
    if(NOT CMAKE_CUDA_ARCHITECTURES)
      set(CMAKE_CUDA_ARCHITECTURES 75-real 80-real 90-real 90-virtual CACHE STRING
          "CUDA architectures: Turing, Ampere, Hopper; newer devices compile the PTX")
    endif()
    set(CMAKE_CUDA_COMPILER ${VOXDAG_NVCC} CACHE FILEPATH "")
    if(VOXDAG_CCACHE AND NOT CMAKE_CUDA_COMPILER_LAUNCHER)
      set(CMAKE_CUDA_COMPILER_LAUNCHER ${VOXDAG_CCACHE})
    endif()
    enable_language(CUDA)
    # CMake 3.25 of Debian 12 does not know that nvcc 12 and later support C++20.
    if(NOT CMAKE_CUDA20_STANDARD_COMPILE_OPTION)
      set(CMAKE_CUDA20_STANDARD_COMPILE_OPTION -std=c++20)
      set(CMAKE_CUDA20_EXTENSION_COMPILE_OPTION -std=c++20)
      list(APPEND CMAKE_CUDA_COMPILE_FEATURES cuda_std_20)
    endif()
    # The static runtime lets programs run on machines without an installed CUDA.
    find_package(CUDAToolkit REQUIRED)
    set(VOXDAG_HAS_CUDA ON)
  else()
    message(STATUS "voxdag: nvcc not found: no `--device cuda`")
  endif()
endif()
