#pragma once
/// What the parts of the runtime share.
#include <cuda_runtime_api.h>

#include <deque>
#include <functional>

/// Steps that are done one after the other.
struct CUstream_st {
  /// Does the step later, or now where the device is eager.
  cudaError_t add(std::function<cudaError_t()> step);
  /// Does all there are, up to the first that fails.
  cudaError_t finish();

  std::deque<std::function<cudaError_t()>> steps;
};

namespace voxdag {

/// While one lives the device's memory can be touched.
class DeviceAtWork {
 public:
  DeviceAtWork();
  DeviceAtWork(const DeviceAtWork&) = delete;
  DeviceAtWork& operator=(const DeviceAtWork&) = delete;
  ~DeviceAtWork();
};

/// Begins a call: an error where it is the one that is to fail.
cudaError_t begin_call();
/// Returns `status`, and remembers it where it is an error.
cudaError_t end_call(cudaError_t status);

}  // namespace voxdag
