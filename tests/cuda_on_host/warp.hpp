#pragma once
/// Threads of a kernel that run together, on the host.
#include <cuda_runtime_api.h>
#include <ucontext.h>

#include <array>
#include <cstddef>
#include <functional>
#include <memory>

namespace voxdag {

/// Up to 32 threads, that take turns, each on a stack of its own.
class Warp {
 public:
  static constexpr unsigned kSize = 32;

  Warp() : stacks_(new std::byte[kSize * kStackBytes]) {}

  /// Calls `thread` for the place `first` in the block and those after it that are in the warp.
  void run(const std::function<void()>& thread, const dim3& block, unsigned first);
  /// For the thread that runs: waits until all have come here.
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
