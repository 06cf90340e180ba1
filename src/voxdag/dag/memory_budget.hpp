#pragma once
/// Keeps a build within the memory it was given.
#include <atomic>
#include <cstdint>

namespace voxdag {

/// Counts the bytes that a build holds. Thread-safe.
class MemoryBudget {
 public:
  /// `limit` in bytes for everything counted here and the `base` bytes that the process holds
  /// already; 0 means none.
  explicit MemoryBudget(std::uint64_t limit = 0, std::uint64_t base = 0)
      : limit_(limit), base_(base) {}

  void add(std::uint64_t bytes) {
    const std::uint64_t now = used_.fetch_add(bytes, std::memory_order_relaxed) + bytes;
    if (now > peak_.load(std::memory_order_relaxed)) peak_.store(now, std::memory_order_relaxed);
    if (limit_ != 0 && now + base_ > limit_) exceeded_.store(true, std::memory_order_relaxed);
  }
  void remove(std::uint64_t bytes) { used_.fetch_sub(bytes, std::memory_order_relaxed); }

  std::uint64_t limit() const { return limit_; }
  std::uint64_t base() const { return base_; }
  std::uint64_t used() const { return used_.load(std::memory_order_relaxed); }
  std::uint64_t peak() const { return peak_.load(std::memory_order_relaxed); }
  /// Set once more was added than the limit; the build looks between tasks and stops.
  bool exceeded() const { return exceeded_.load(std::memory_order_relaxed); }

 private:
  std::uint64_t limit_, base_;
  std::atomic<std::uint64_t> used_{0}, peak_{0};
  std::atomic<bool> exceeded_{false};
};

}  // namespace voxdag
