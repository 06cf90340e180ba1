#pragma once
/// A mutex that threads get in the order in which they asked for it.
#include <atomic>
#include <cstdint>

namespace voxdag {

/// A thread that takes a std::mutex again and again can keep others out for seconds. Here each
/// thread draws a number and waits for its turn. Meets BasicLockable.
class TurnLock {
 public:
  void lock() {
    const std::uint32_t mine = drawn_.fetch_add(1, std::memory_order_relaxed);
    for (std::uint32_t now; (now = turn_.load(std::memory_order_acquire)) != mine;)
      turn_.wait(now, std::memory_order_acquire);
  }
  void unlock() {
    turn_.fetch_add(1, std::memory_order_release);
    turn_.notify_all();
  }

 private:
  std::atomic<std::uint32_t> drawn_{0}, turn_{0};
};

}  // namespace voxdag
