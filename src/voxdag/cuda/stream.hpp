#pragma once
/// CUDA streams (queues of copies and kernels) and events in them.
#include <utility>

#include "voxdag/cuda/check.hpp"

namespace voxdag {

class CudaStream {
 public:
  CudaStream() { check_cuda(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking), "queue"); }
  CudaStream(const CudaStream&) = delete;
  CudaStream& operator=(const CudaStream&) = delete;
  /// Waits for the stream, because after an exception its work may still use memory that is about
  /// to be freed.
  ~CudaStream() {
    cudaStreamSynchronize(stream_);
    cudaStreamDestroy(stream_);
  }

  cudaStream_t get() const { return stream_; }
  /// Waits until the stream is empty; `doing` names the work in errors.
  void wait(const char* doing) const { check_cuda(cudaStreamSynchronize(stream_), doing); }

 private:
  cudaStream_t stream_ = nullptr;
};

/// A moment in a stream.
class CudaEvent {
 public:
  CudaEvent() { check_cuda(cudaEventCreate(&event_), "clock"); }
  CudaEvent(const CudaEvent&) = delete;
  CudaEvent& operator=(const CudaEvent&) = delete;
  ~CudaEvent() { cudaEventDestroy(event_); }

  void record(const CudaStream& stream) const {
    check_cuda(cudaEventRecord(event_, stream.get()), "clock");
  }
  /// Returns the seconds between two events, both of which must have completed.
  friend double seconds_between(const CudaEvent& begin, const CudaEvent& end) {
    float milliseconds = 0;
    check_cuda(cudaEventElapsedTime(&milliseconds, begin.event_, end.event_), "clock");
    return static_cast<double>(milliseconds) * 1e-3;
  }

 private:
  cudaEvent_t event_ = nullptr;
};

/// Returns the device time, in seconds, of the work that `launch(stream)` starts. `doing` names it
/// for errors.
template <class Launch>
double seconds_of(const char* doing, const Launch& launch) {
  const CudaStream stream;
  const CudaEvent begin, end;
  begin.record(stream);
  launch(stream.get());
  end.record(stream);
  stream.wait(doing);
  return seconds_between(begin, end);
}

}  // namespace voxdag
