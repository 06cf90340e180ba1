#pragma once
/// A hash table that gives equal items one number, for many threads.
///
/// The table is split into shards by hash. Threads find an existing item, the common case, without
/// a lock; to add one they lock its shard. Slots are those of core/number_table.hpp; slots without
/// a number are free.
///
///   table   | address, log2 of the number of slots in its low 6 bits |
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "voxdag/core/number_table.hpp"
#include "voxdag/core/page_vector.hpp"

namespace voxdag {

class SpinLock {
 public:
  explicit SpinLock(std::atomic_flag& flag) : flag_(flag) {
    for (int spins = 0; flag_.test_and_set(std::memory_order_acquire); ++spins)
      if (spins > 64) yield();
  }
  ~SpinLock() { flag_.clear(std::memory_order_release); }
  SpinLock(const SpinLock&) = delete;
  SpinLock& operator=(const SpinLock&) = delete;

  static void yield();

 private:
  std::atomic_flag& flag_;
};

class SharedNumberTable {
 public:
  /// A null budget counts nothing.
  explicit SharedNumberTable(MemoryBudget* budget) : budget_(budget) {}
  ~SharedNumberTable() { release(); }
  SharedNumberTable(const SharedNumberTable&) = delete;
  SharedNumberTable& operator=(const SharedNumberTable&) = delete;

  /// Returns the number of the item with this hash for which is_equal(number) is true. If there is
  /// none, stores the item by prepare(), which returns its number, and calls keep() when it is in
  /// the table; if another thread added an equal item meanwhile, returns that one and does not call
  /// keep(). Adds `weight` to weight(). Thread-safe, if the arguments are. Throws OverMemory and
  /// std::bad_alloc.
  template <class IsEqual, class Prepare, class Keep>
  std::uint32_t find_or_add(std::uint64_t hash, std::uint32_t weight, const IsEqual& is_equal,
                            const Prepare& prepare, const Keep& keep) {
    const std::uint32_t tag = NumberSlots::tag_of(hash);
    std::uint64_t slot = 0;
    const NumberSlots before = table_of(hash);
    if (before.slots != nullptr) {
      before.find(tag, is_equal, slot);
      if (slot != 0) return NumberSlots::number_of(slot);
    } else {
      grow(shard_of(hash));
    }
    const std::uint32_t number = prepare();
    Shard& shard = shards_[shard_of(hash)];
    for (;;) {
      bool added = false, to_grow = false;
      {
        const SpinLock guard(shard.lock);
        const NumberSlots table = table_of(hash);
        std::uint64_t* free = table.find(tag, is_equal, slot);
        if (slot != 0) return NumberSlots::number_of(slot);
        const std::uint64_t eighths = (shard.count + std::uint64_t{1}) * 8;
        added = eighths <= table.count * kFullEighths;
        if (added) {
          std::atomic_ref(*free).store(NumberSlots::slot_of(tag, number),
                                       std::memory_order_release);
          ++shard.count;
          shard.weight += weight;
        }
        if (eighths > table.count * kGrowEighths && !shard.growing) shard.growing = to_grow = true;
      }
      if (added) keep();
      if (to_grow) grow(shard_of(hash));
      if (added) return number;
      if (!to_grow) SpinLock::yield();
    }
  }

  /// Starts loading the slot that a search for this hash reads first.
  void prefetch(std::uint64_t hash) const {
    const NumberSlots table = table_of(hash);
    if (table.slots != nullptr)
      __builtin_prefetch(table.slots + table.first_of(NumberSlots::tag_of(hash)));
  }
  /// Returns whether there is an item with the hash's tag, and its number. Reads the slot, so call
  /// it when the load of prefetch() has had time to finish.
  bool find_tag(std::uint64_t hash, std::uint32_t& number) const {
    const NumberSlots table = table_of(hash);
    if (table.slots == nullptr) return false;
    std::uint64_t slot = 0;
    table.find(
        NumberSlots::tag_of(hash), [](std::uint32_t) { return true; }, slot);
    if (slot != 0) number = NumberSlots::number_of(slot);
    return slot != 0;
  }
  /// Returns the number of items, and the sum of their weights. Not thread-safe, like the functions
  /// below.
  std::uint64_t count() const;
  std::uint64_t weight() const;
  /// Removes the numbers for which keep(number) is false. Throws OverMemory.
  template <class Keep>
  void retain(const Keep& keep) {
    for (std::uint32_t i = 0; i < kShards; ++i) {
      Shard& shard = shards_[i];
      if (shard.tables.empty()) continue;
      PageVector<std::uint64_t>& old = shard.tables.back();
      shard.count = 0;
      for (std::uint64_t& slot : old)
        if (slot != 0 && !keep(NumberSlots::number_of(slot)))
          slot = 0;
        else
          shard.count += slot != 0 ? 1 : 0;
      replace(i, old.size());
    }
  }
  /// Frees all slots. count() and weight() stay.
  void release();

 private:
  static constexpr int kShardBits = 4;
  static constexpr std::uint32_t kShards = 1u << kShardBits;
  /// The first thread that sees a table with kGrowEighths eighths full grows it. Meanwhile other
  /// threads add items to it until kFullEighths eighths are full, and then wait.
  static constexpr std::uint64_t kGrowEighths = 5, kFullEighths = 7;

  struct alignas(64) Shard {
    std::atomic_flag lock = ATOMIC_FLAG_INIT;
    bool growing = false;
    std::uint64_t count = 0, weight = 0;
    // Old tables keep their addresses until release(), because another thread may be reading them.
    // Their memory is freed and reads as zeros: a lookup finds nothing there and continues in the
    // newest table.
    std::vector<PageVector<std::uint64_t>> tables;
  };

  static std::uint32_t shard_of(std::uint64_t hash) {
    return static_cast<std::uint32_t>(hash >> (64 - kShardBits));
  }
  /// Returns the table of the hash's shard; `slots` is null before the shard's first item.
  NumberSlots table_of(std::uint64_t hash) const {
    const std::uint64_t packed = tables_[shard_of(hash)].load(std::memory_order_acquire);
    return {reinterpret_cast<std::uint64_t*>(packed & ~std::uint64_t{63}),
            std::uint64_t{1} << (packed & 63)};
  }
  void grow(std::uint32_t shard_index);
  /// Gives a shard a new table of `size` slots, a power of two, with the items of its last one.
  void replace(std::uint32_t shard_index, std::uint64_t size);

  // Kept apart from the shards, because every lookup reads these while adding an item writes to the
  // shards.
  alignas(64) std::array<std::atomic<std::uint64_t>, kShards> tables_{};
  std::unique_ptr<Shard[]> shards_{new Shard[kShards]};
  MemoryBudget* budget_;
};

}  // namespace voxdag
