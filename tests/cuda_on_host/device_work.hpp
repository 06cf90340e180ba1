#pragma once
/// Internals that the parts of the test runtime share.
#include <cuda_runtime_api.h>

#include <deque>
#include <functional>

/// A queue of steps that run one after the other.
struct CUstream_st {
  /// Queues the step; an eager device runs it immediately.
  cudaError_t add(std::function<cudaError_t()> step);
  /// Runs all queued steps, up to the first that fails.
  cudaError_t finish();

  std::deque<std::function<cudaError_t()>> steps;
};

namespace voxdag {

/// Makes the device's memory accessible while it lives.
class DeviceAtWork {
 public:
  DeviceAtWork();
  DeviceAtWork(const DeviceAtWork&) = delete;
  DeviceAtWork& operator=(const DeviceAtWork&) = delete;
  ~DeviceAtWork();
};

/// Begins a call of the runtime: returns an error if HostDevice::failing_call says so.
cudaError_t begin_call();
/// Returns `status`; an error also becomes the last error.
cudaError_t end_call(cudaError_t status);

}  // namespace voxdag
