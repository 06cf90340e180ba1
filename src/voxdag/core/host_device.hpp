#pragma once
/// Functions that both the host compiler and nvcc compile carry VOXDAG_HD.
#if defined(__CUDACC__)
#define VOXDAG_HD __host__ __device__
#else
#define VOXDAG_HD
#endif
