#pragma once
/// A warp of CUDA threads on the host.
#include <cuda_runtime_api.h>
#include <ucontext.h>

#include <array>
#include <cstddef>
#include <functional>
#include <memory>

namespace voxdag {

/// Up to 32 threads that take turns, each on its own stack.
class Warp {
 public:
  static constexpr unsigned kSize = 32;

  Warp() : stacks_(new std::byte[kSize * kStackBytes]) {}

  /// Runs `thread` for the threads of the warp that begins with thread `first` of the block.
  void run(const std::function<void()>& thread, const dim3& block, unsigned first);
  /// Waits until all threads of the warp have called it, and returns the value of the thread `by`
  /// lanes on. A running thread calls it.
  unsigned long long value_down(unsigned long long value, unsigned by);

 private:
  static constexpr std::size_t kStackBytes = std::size_t{1} << 18;

  void begin(unsigned lane);
  static void run_thread();

  std::unique_ptr<std::byte[]> stacks_;
  const std::function<void()>* thread_ = nullptr;
  ucontext_t caller_{};
  std::array<ucontext_t, kSize> contexts_{};
  std::array<bool, kSize> is_done_{};
  std::array<std::array<unsigned long long, kSize>, 2> values_{};
  unsigned size_ = 0, lane_ = 0, round_ = 0;
};

}  // namespace voxdag
