#pragma once
/// A queue of copies and kernels that run one after the other.
#include <utility>

#include "voxdag/cuda/check.hpp"

namespace voxdag {

class CudaStream {
 public:
  CudaStream() { check_cuda(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking), "queue"); }
  CudaStream(const CudaStream&) = delete;
  CudaStream& operator=(const CudaStream&) = delete;
  ~CudaStream() { cudaStreamDestroy(stream_); }

  cudaStream_t get() const { return stream_; }
  /// Waits until all is done; `doing` names it for errors.
  void wait(const char* doing) const { check_cuda(cudaStreamSynchronize(stream_), doing); }

 private:
  cudaStream_t stream_ = nullptr;
};

}  // namespace voxdag
