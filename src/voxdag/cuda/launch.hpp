#pragma once
/// Launches kernels; for .cu files.
#include <cuda_runtime.h>

#include <utility>

#include "voxdag/cuda/check.hpp"

namespace voxdag {

/// Queues kernel(arguments...) for `blocks` blocks of `threads` threads, at least one of each.
/// Throws Error on failure; `doing` names the operation: "casting rays". It is a function instead
/// of <<< >>>, so that tests can compile kernels for the host.
template <class... Parameters, class... Arguments>
void launch(const char* doing, void (*kernel)(Parameters...), dim3 blocks, dim3 threads,
            cudaStream_t stream, Arguments&&... arguments) {
  cudaLaunchConfig_t config{};
  config.gridDim = blocks;
  config.blockDim = threads;
  config.stream = stream;
  check_cuda(cudaLaunchKernelEx(&config, kernel, std::forward<Arguments>(arguments)...), doing);
}

}  // namespace voxdag
