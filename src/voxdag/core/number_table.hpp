#pragma once
/// Hash tables that give equal items one number. The items lie elsewhere.
///
/// The tables use open addressing with linear probing. The tag alone decides where a search begins,
/// so that a table grows without reading its items.
///
///   slot    | tag: the low 32 bits of the hash | number + 1 |     0 = free
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "voxdag/core/int128.hpp"
#include "voxdag/core/memory_budget.hpp"

namespace voxdag {

/// Returns a hash of words: 64-bit multiply and fold.
inline std::uint64_t hash_words(const std::uint32_t* words, int count) {
  std::uint64_t h = 0x9E3779B97F4A7C15ull ^ static_cast<std::uint64_t>(count);
  for (int i = 0; i < count; i += 2) {
    const std::uint64_t pair =
        words[i] | (i + 1 < count ? static_cast<std::uint64_t>(words[i + 1]) << 32 : 0);
    const Uint128 product = static_cast<Uint128>(h ^ pair) * 0xD6E8FEB86659FD93ull;
    h = static_cast<std::uint64_t>(product) ^ static_cast<std::uint64_t>(product >> 64);
  }
  return h ^ (h >> 32);
}

/// A view of the slots of a table; one of them at least is free. Threads may search while others
/// fill slots, through std::atomic_ref.
struct NumberSlots {
  std::uint64_t* slots = nullptr;
  std::uint64_t count = 0;

  /// Numbers are below kMaxNumbers.
  static constexpr std::uint32_t kMaxNumbers = 0xFFFFFFFFu;

  static std::uint32_t tag_of(std::uint64_t hash) { return static_cast<std::uint32_t>(hash); }
  static std::uint64_t slot_of(std::uint32_t tag, std::uint32_t number) {
    return std::uint64_t{tag} << 32 | (number + 1);
  }
  /// Returns the number in a slot that is not free.
  static std::uint32_t number_of(std::uint64_t slot) {
    return static_cast<std::uint32_t>(slot) - 1;
  }

  /// Returns the index of the slot where a search begins.
  std::uint64_t first_of(std::uint32_t tag) const {
    return tag * (count >> 32) + (tag * (count & 0xFFFFFFFFu) >> 32);
  }
  /// Returns the slot that a search tries after slot i.
  std::uint64_t next(std::uint64_t i) const { return i + 1 < count ? i + 1 : 0; }
  /// Returns the first slot with this tag and a number for which is_equal(number) is true, or the
  /// free slot where it belongs. Sets `found` to what the slot holds.
  template <class IsEqual>
  std::uint64_t* find(std::uint32_t tag, const IsEqual& is_equal, std::uint64_t& found) const {
    for (std::uint64_t i = first_of(tag);; i = next(i)) {
      // Acquires the item that the slot's writer stored before the slot.
      found = std::atomic_ref(slots[i]).load(std::memory_order_acquire);
      if (found == 0 || (found >> 32 == tag && is_equal(number_of(found)))) return slots + i;
    }
  }
  /// Adds the numbers of another table.
  void add_all(const NumberSlots& other) const {
    for (std::uint64_t i = 0; i < other.count; ++i) {
      if (other.slots[i] == 0) continue;
      std::uint64_t to = first_of(tag_of(other.slots[i] >> 32));
      while (slots[to] != 0) to = next(to);
      slots[to] = other.slots[i];
    }
  }
};

/// A table that grows, for one thread. At most three quarters of the slots are used.
class NumberTable {
 public:
  /// Makes an empty table. A null budget counts nothing.
  explicit NumberTable(MemoryBudget* memory) : slots_(memory) {}

  /// Returns the number of the item with this hash for which is_equal(number) is true. If there is
  /// none, returns add(), which stores the item and returns its number. Throws OverMemory.
  template <class IsEqual, class Add>
  std::uint32_t find_or_add(std::uint64_t hash, const IsEqual& is_equal, const Add& add) {
    if ((count_ + 1) * 4 > slots_.size() * 3) grow();
    const std::uint32_t tag = NumberSlots::tag_of(hash);
    std::uint64_t found = 0;
    std::uint64_t* const slot = view(slots_).find(tag, is_equal, found);
    if (found == 0) {
      *slot = found = NumberSlots::slot_of(tag, add());
      ++count_;
    }
    return NumberSlots::number_of(found);
  }

  /// Prefetches the slot where a search for this hash begins.
  void prefetch(std::uint64_t hash) const {
    __builtin_prefetch(slots_.data() + view().first_of(NumberSlots::tag_of(hash)), 1);
  }
  /// Returns a number that find_or_add() is likely to compare first, or kMaxNumbers.
  std::uint32_t likely(std::uint64_t hash) const {
    if (slots_.empty()) return NumberSlots::kMaxNumbers;
    const std::uint32_t tag = NumberSlots::tag_of(hash);
    const std::uint64_t slot = slots_[view().first_of(tag)];
    return slot >> 32 == tag ? NumberSlots::number_of(slot) : NumberSlots::kMaxNumbers;
  }

  /// Removes the numbers for which keep(number) is false. Throws OverMemory.
  template <class Keep>
  void retain(const Keep& keep) {
    CountedVector<std::uint64_t> kept(slots_.size(), 0, slots_.get_allocator());
    count_ = 0;
    for (std::uint64_t& slot : slots_)
      if (slot != 0 && !keep(NumberSlots::number_of(slot)))
        slot = 0;
      else
        count_ += slot != 0 ? 1 : 0;
    view(kept).add_all(view(slots_));
    slots_.swap(kept);
  }

 private:
  static NumberSlots view(CountedVector<std::uint64_t>& slots) {
    return {slots.data(), slots.size()};
  }
  NumberSlots view() const { return {const_cast<std::uint64_t*>(slots_.data()), slots_.size()}; }

  void grow() {
    constexpr std::size_t kFirst = 64;
    CountedVector<std::uint64_t> larger(std::max(kFirst, 2 * slots_.size()), 0,
                                        slots_.get_allocator());
    view(larger).add_all(view(slots_));
    slots_.swap(larger);
  }

  std::uint64_t count_ = 0;
  CountedVector<std::uint64_t> slots_;
};

}  // namespace voxdag
