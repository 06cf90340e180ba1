#pragma once
/// A warp of CUDA threads on the host.
#include <cuda_runtime_api.h>
#include <ucontext.h>

#include <array>
#include <cstddef>
#include <functional>
#include <memory>

namespace voxdag {

/// Up to 32 threads that take turns. Threads run one after the other on one stack, because changing
/// stacks takes long, until one of them waits for the others: that one keeps the stack, and the
/// next threads run on a new one.
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

  /// Runs the threads that did not start yet on a new stack, until one of them waits.
  void start_stack(unsigned stack);
  /// Runs on the new stack.
  static void run_threads();
  /// Makes `lane` the running thread.
  void enter(unsigned lane);

  std::unique_ptr<std::byte[]> stacks_;
  const std::function<void()>* thread_ = nullptr;
  dim3 block_{};
  unsigned first_ = 0;  ///< The number of the warp's first thread in the block.
  ucontext_t caller_{};
  std::array<ucontext_t, kSize> contexts_{};
  std::array<bool, kSize> is_done_{};
  std::array<unsigned, kSize> stack_of_{};  ///< The number of each thread's stack.
  std::array<std::array<unsigned long long, kSize>, 2> values_{};
  unsigned size_ = 0, started_ = 0;  ///< Threads of the warp; threads that started.
  unsigned lane_ = 0, round_ = 0;    ///< The running thread; exchanges of values so far.
};

}  // namespace voxdag
