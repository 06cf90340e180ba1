#pragma once
/// A limit on memory that readers, textures and builders share.
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <new>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/huge_pages.hpp"

namespace voxdag {

/// Thrown when work would use more memory than its limit allows.
class OverMemory : public Error {
 public:
  using Error::Error;
};

/// Counts the bytes that work allocates, up to a limit. Thread-safe. Whoever takes a pointer to a
/// budget counts nothing if it is null.
class MemoryBudget {
 public:
  /// Makes a budget of `limit` bytes, which include `base`, the bytes that the process holds
  /// already. A limit of 0 means no limit.
  explicit MemoryBudget(std::uint64_t limit = 0, std::uint64_t base = 0)
      : limit_(limit), base_(base) {}

  /// Counts `bytes` before they are allocated. Throws OverMemory, and counts nothing, if they would
  /// exceed the limit.
  void reserve(std::uint64_t bytes) {
    const std::uint64_t now = used_.fetch_add(bytes, std::memory_order_relaxed) + bytes;
    if (limit_ != 0 && now + base_ > limit_) {
      used_.fetch_sub(bytes, std::memory_order_relaxed);
      exceeded_.store(true, std::memory_order_relaxed);
      throw_over_memory(base_ + now);
    }
    raise_peak(now);
  }
  /// Gives back bytes that reserve() or add() counted.
  void release(std::uint64_t bytes) noexcept { used_.fetch_sub(bytes, std::memory_order_relaxed); }

  /// Counts bytes that are allocated already. Sets exceeded() instead of throwing.
  void add(std::uint64_t bytes) noexcept {
    const std::uint64_t now = used_.fetch_add(bytes, std::memory_order_relaxed) + bytes;
    raise_peak(now);
    if (limit_ != 0 && now + base_ > limit_) exceeded_.store(true, std::memory_order_relaxed);
  }
  /// Gives back bytes that add() counted.
  void remove(std::uint64_t bytes) noexcept { release(bytes); }

  /// Returns the limit in bytes; 0 means no limit.
  std::uint64_t limit() const { return limit_; }
  /// Returns the bytes that the process held before.
  std::uint64_t base() const { return base_; }
  /// Returns the bytes that are counted now, without base().
  std::uint64_t used() const { return used_.load(std::memory_order_relaxed); }
  /// Returns the largest used() so far.
  std::uint64_t peak() const { return peak_.load(std::memory_order_relaxed); }
  /// Returns the number of bytes that can still be reserved.
  std::uint64_t left() const {
    if (limit_ == 0) return std::numeric_limits<std::uint64_t>::max();
    const std::uint64_t held = base_ + used();
    return held < limit_ ? limit_ - held : 0;
  }
  /// Returns whether reserve() or add() ever went over the limit. Work that uses add() checks this
  /// between tasks and stops.
  bool exceeded() const { return exceeded_.load(std::memory_order_relaxed); }

  /// Throws OverMemory: "the memory limit of A MiB is too small: at least B MiB are needed".
  [[noreturn]] void throw_over_memory(std::uint64_t needed_bytes) const {
    const auto mebibytes = [](std::uint64_t bytes) {
      return std::to_string((bytes + (std::uint64_t{1} << 20) - 1) >> 20) + " MiB";
    };
    throw OverMemory("the memory limit of " + mebibytes(limit_) + " is too small: at least " +
                     mebibytes(needed_bytes) + " are needed");
  }

 private:
  void raise_peak(std::uint64_t now) noexcept {
    std::uint64_t peak = peak_.load(std::memory_order_relaxed);
    while (now > peak && !peak_.compare_exchange_weak(peak, now, std::memory_order_relaxed)) {
    }
  }

  std::uint64_t limit_, base_;
  std::atomic<std::uint64_t> used_{0}, peak_{0};
  std::atomic<bool> exceeded_{false};
};

/// Reserves bytes of a budget and releases them in its destructor. Move-only. A null budget counts
/// nothing.
class MemoryReservation {
 public:
  MemoryReservation() = default;
  /// Reserves `bytes`. Throws OverMemory.
  MemoryReservation(MemoryBudget* budget, std::uint64_t bytes) : budget_(budget), bytes_(bytes) {
    if (budget_ != nullptr) budget_->reserve(bytes_);
  }
  MemoryReservation(MemoryReservation&& other) noexcept
      : budget_(std::exchange(other.budget_, nullptr)), bytes_(std::exchange(other.bytes_, 0)) {}
  MemoryReservation& operator=(MemoryReservation&& other) noexcept {
    std::swap(budget_, other.budget_);
    std::swap(bytes_, other.bytes_);
    return *this;
  }
  ~MemoryReservation() {
    if (budget_ != nullptr) budget_->release(bytes_);
  }

  /// Changes the number of reserved bytes to `bytes`. Throws OverMemory.
  void resize(std::uint64_t bytes) {
    if (budget_ != nullptr && bytes > bytes_) budget_->reserve(bytes - bytes_);
    if (budget_ != nullptr && bytes < bytes_) budget_->release(bytes_ - bytes);
    bytes_ = bytes;
  }
  std::uint64_t bytes() const { return bytes_; }
  /// Gives up the bytes without releasing them; the caller must release them.
  void keep() noexcept { bytes_ = 0; }

 private:
  MemoryBudget* budget_ = nullptr;
  std::uint64_t bytes_ = 0;
};

/// An allocator that reserves its memory from a budget, so that a CountedVector cannot exceed the
/// limit. A null budget counts nothing. Moved and swapped containers keep their budget.
template <class T>
class CountedAllocator {
 public:
  using value_type = T;
  using propagate_on_container_copy_assignment = std::true_type;
  using propagate_on_container_move_assignment = std::true_type;
  using propagate_on_container_swap = std::true_type;

  CountedAllocator(MemoryBudget* budget = nullptr) noexcept : budget_(budget) {}
  template <class U>
  CountedAllocator(const CountedAllocator<U>& other) noexcept : budget_(other.budget()) {}

  /// Allocates `count` objects. Throws OverMemory or std::bad_alloc.
  T* allocate(std::size_t count) {
    if (count > std::numeric_limits<std::size_t>::max() / sizeof(T))
      throw std::bad_array_new_length();
    const std::size_t bytes = count * sizeof(T);
    if (budget_ != nullptr) budget_->reserve(bytes);
    try {
      void* const memory = ::operator new (bytes, std::align_val_t{alignof(T)});
      constexpr std::size_t kLarge = std::size_t{8} << 20;
      if (bytes >= kLarge) prefer_huge_pages(memory, bytes);
      return static_cast<T*>(memory);
    } catch (...) {
      if (budget_ != nullptr) budget_->release(bytes);
      throw;
    }
  }
  // Not inlined: if it is, GCC 12 warns wrongly that the vector uses freed pointers.
  [[gnu::noinline]] void deallocate(T* memory, std::size_t count) noexcept {
    ::operator delete (memory, std::align_val_t{alignof(T)});
    if (budget_ != nullptr) budget_->release(count * sizeof(T));
  }

  MemoryBudget* budget() const { return budget_; }
  friend bool operator==(const CountedAllocator& a, const CountedAllocator& b) {
    return a.budget_ == b.budget_;
  }

 private:
  MemoryBudget* budget_;
};

template <class T>
using CountedVector = std::vector<T, CountedAllocator<T>>;

}  // namespace voxdag
