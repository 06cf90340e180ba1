#pragma once
/// Converts error codes of the CUDA runtime to Error.
#include <cuda_runtime_api.h>

#include "voxdag/core/error.hpp"

namespace voxdag {

/// Throws Error unless `status` is a success. `doing` names the operation for the error: "copying
/// rays to the device".
inline void check_cuda(cudaError_t status, const char* doing) {
  if (status == cudaSuccess) return;
  cudaGetLastError();  // clears the error, so that later calls do not report it again
  throw Error("CUDA", doing, cudaGetErrorString(status));
}

}  // namespace voxdag
