#pragma once
/// VOXDAG_HD marks functions that both the host compiler and nvcc compile.
#if defined(__CUDACC__)
#define VOXDAG_HD __host__ __device__
#else
#define VOXDAG_HD
#endif

/// Forces inlining even across target attributes, so that the code is compiled for its caller's
/// instruction set.
#if defined(__CUDACC__)
#define VOXDAG_FORCE_INLINE __forceinline__
#else
#define VOXDAG_FORCE_INLINE inline __attribute__((always_inline))
#endif
