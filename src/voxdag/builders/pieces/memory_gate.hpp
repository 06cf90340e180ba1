#pragma once
/// Lets threads build at the same time only while enough memory is left.
#include <condition_variable>
#include <cstdint>
#include <mutex>

#include "voxdag/core/memory_budget.hpp"

namespace voxdag {

class MemoryGate {
 public:
  /// If `budget` is null, no thread waits.
  explicit MemoryGate(MemoryBudget* budget) : budget_(budget) {}

  /// A thread holds a pass while it uses memory that the gate promised.
  class Pass {
   public:
    /// Waits until the budget has `bytes` left in addition to the bytes promised to other passes,
    /// or until there is no other pass. A thread with a pass must not wait for threads with other
    /// passes.
    Pass(MemoryGate& gate, std::uint64_t bytes) : gate_(gate), bytes_(bytes) {
      std::unique_lock lock(gate_.mutex_);
      gate_.left_.wait(lock, [&] { return gate_.holders_ == 0 || gate_.has_left(bytes_); });
      ++gate_.holders_;
      gate_.promised_ += bytes_;
    }
    ~Pass() {
      {
        const std::lock_guard lock(gate_.mutex_);
        --gate_.holders_;
        gate_.promised_ -= bytes_;
      }
      gate_.left_.notify_all();
    }
    Pass(const Pass&) = delete;
    Pass& operator=(const Pass&) = delete;

   private:
    MemoryGate& gate_;
    std::uint64_t bytes_;
  };

 private:
  bool has_left(std::uint64_t bytes) const {
    return budget_ == nullptr || budget_->left() >= promised_ + bytes;
  }

  MemoryBudget* budget_;
  std::mutex mutex_;
  std::condition_variable left_;
  int holders_ = 0;
  std::uint64_t promised_ = 0;
};

}  // namespace voxdag
