#pragma once
/// From the error codes of the CUDA runtime to Error.
#include <cuda_runtime_api.h>

#include "voxdag/core/error.hpp"

namespace voxdag {

/// `doing` says what failed: "copying rays to the device".
inline void check_cuda(cudaError_t status, const char* doing) {
  if (status == cudaSuccess) return;
  cudaGetLastError();  // where the error is not a lasting one, later calls are not to find it
  throw Error("CUDA", doing, cudaGetErrorString(status));
}

}  // namespace voxdag
