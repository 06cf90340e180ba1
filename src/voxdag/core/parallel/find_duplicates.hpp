#pragma once
/// Finds the items that repeat an item with a lower index.
#include <algorithm>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "voxdag/core/number_table.hpp"
#include "voxdag/core/page_vector.hpp"
#include "voxdag/core/parallel/polled_for.hpp"

namespace voxdag {

/// A set of indices, one bit for each. Takes no memory while no index was added.
class IndexSet {
 public:
  /// Makes the empty set of indices below `capacity`. A null budget counts nothing.
  explicit IndexSet(std::size_t capacity = 0, MemoryBudget* budget = nullptr)
      : capacity_(capacity), words_(budget) {}

  bool contains(std::size_t index) const {
    return !words_.empty() && ((words_[index / 64] >> (index % 64)) & 1) != 0;
  }
  bool empty() const { return words_.empty(); }
  std::size_t count() const {
    std::size_t count = 0;
    for (const std::uint64_t word : words_) count += static_cast<std::size_t>(std::popcount(word));
    return count;
  }

  /// Makes room for all indices. After it, insert() may be called by several threads at once.
  /// Throws OverMemory.
  void allocate() { words_.resize(capacity_ / 64 + 1); }
  void insert(std::size_t index) {
    std::atomic_ref(words_[index / 64])
        .fetch_or(std::uint64_t{1} << (index % 64), std::memory_order_relaxed);
  }
  /// Frees the memory of a set to which nothing was added.
  void release() { words_.release(); }

 private:
  std::size_t capacity_;
  PageVector<std::uint64_t> words_;
};

/// Returns which of the items 0 to `count` - 1 (fewer than 2^32) equal one with a lower index.
///
/// `items.hash(i)` returns 64 bits that are equal for equal items, or std::nullopt if item i counts
/// as equal to none; `items.are_equal(a, b)` compares two items. Both are called by several threads
/// at once. The result does not depend on the number of threads. Time is linear in the items if the
/// hashes are good. Takes 12 bytes for each item while it works and 1/8 byte after. Counts it in
/// `work`, polls and reports as `stage`. Throws OverMemory and Cancelled.
//
// All threads share the table. A slot holds the lowest index seen so far of its item. Of two equal
// items the one with the higher index is marked, so the marks do not depend on the order.
template <class Items>
IndexSet find_duplicates(std::size_t count, const Items& items, Work work, std::string_view stage) {
  constexpr std::size_t kGrain = 4096;
  IndexSet duplicates(count, work.memory);
  duplicates.allocate();
  PageVector<std::uint64_t> slots(work.memory);
  slots.resize(count + count / 2 + 1);
  const NumberSlots table{slots.data(), slots.size()};
  std::atomic<bool> any{false};
  polled_for(count, kGrain, work, stage, [&](std::size_t index) {
    const std::optional<std::uint64_t> hash = items.hash(index);
    if (!hash) return;
    const auto i = static_cast<std::uint32_t>(index);
    const std::uint32_t tag = NumberSlots::tag_of(*hash);
    for (;;) {
      std::uint64_t seen = 0;
      std::atomic_ref slot(*table.find(
          tag, [&](std::uint32_t other) { return items.are_equal(other, i); }, seen));
      const bool is_new = seen == 0;
      const std::uint32_t other = NumberSlots::number_of(seen);
      if ((is_new || i < other) && !slot.compare_exchange_strong(seen, NumberSlots::slot_of(tag, i),
                                                                 std::memory_order_relaxed))
        continue;  // another thread was faster
      if (is_new) return;
      duplicates.insert(std::max(i, other));
      any.store(true, std::memory_order_relaxed);
      return;
    }
  });
  if (!any.load()) duplicates.release();
  return duplicates;
}

}  // namespace voxdag
