#pragma once
/// Numbers different items in the order in which they are first met.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "voxdag/core/error.hpp"
#include "voxdag/core/memory_budget.hpp"

namespace voxdag {

/// Returns a hash of words: multiply and fold.
inline std::size_t hash_of(const std::uint32_t* words, std::size_t size) {
  std::uint64_t h = size;
  for (std::size_t i = 0; i < size; ++i) {
    h = (h ^ words[i]) * 0x9E3779B97F4A7C15ull;
    h ^= h >> 29;
  }
  return static_cast<std::size_t>(h ^ h >> 32);
}

/// The slots of a hash table of numbers. Linear probing; at most half of the slots are used.
class NumberSlots {
 public:
  static constexpr std::uint32_t kFree = std::numeric_limits<std::uint32_t>::max();

  explicit NumberSlots(MemoryBudget* memory) : slots_(64, kFree, memory) {}

  /// Returns the slot of the first number after `hash` for which is_equal(number) is true, or the
  /// free slot where it belongs.
  template <class IsEqual>
  std::uint32_t& find(std::size_t hash, const IsEqual& is_equal) {
    std::size_t slot = hash & (slots_.size() - 1);
    while (slots_[slot] != kFree && !is_equal(slots_[slot])) slot = next(slot);
    return slots_[slot];
  }
  bool is_full(std::size_t count) const { return (count + 1) * 2 > slots_.size(); }
  /// Doubles the number of slots. Calls for_each(add), which calls add(number, hash) for all
  /// numbers.
  template <class ForEach>
  void grow(const ForEach& for_each) {
    CountedVector<std::uint32_t>(slots_.size() * 2, kFree, slots_.get_allocator()).swap(slots_);
    for_each([this](std::uint32_t number, std::size_t hash) {
      std::size_t slot = hash & (slots_.size() - 1);
      while (slots_[slot] != kFree) slot = next(slot);
      slots_[slot] = number;
    });
  }

 private:
  std::size_t next(std::size_t slot) const { return (slot + 1) & (slots_.size() - 1); }

  CountedVector<std::uint32_t> slots_;
};

/// Different arrays of N words.
template <std::size_t N>
class UniqueKeys {
 public:
  using Key = std::array<std::uint32_t, N>;

  explicit UniqueKeys(MemoryBudget* memory) : keys_(memory), slots_(memory) {}

  /// Returns the key's number. Throws Error if there are 2^32 - 1 keys.
  std::uint32_t add(const Key& key) {
    if (slots_.is_full(keys_.size()))
      slots_.grow([this](const auto& add_number) {
        for (std::uint32_t n = 0; n < keys_.size(); ++n) add_number(n, hash_of(keys_[n].data(), N));
      });
    std::uint32_t& slot = slots_.find(hash_of(key.data(), N),
                                      [&](std::uint32_t n) { return are_equal(keys_[n], key); });
    if (slot != NumberSlots::kFree) return slot;
    if (keys_.size() == NumberSlots::kFree)
      throw Error("the DAGs are too large: a level has 2^32 different cells or more");
    slot = static_cast<std::uint32_t>(keys_.size());
    keys_.push_back(key);
    return slot;
  }
  /// Returns the keys by their numbers, and forgets them.
  CountedVector<Key> take() { return std::move(keys_); }

 private:
  /// The operator of std::array calls memcmp().
  static bool are_equal(const Key& a, const Key& b) {
    std::uint32_t different = 0;
    for (std::size_t i = 0; i < N; ++i) different |= a[i] ^ b[i];
    return different == 0;
  }

  CountedVector<Key> keys_;
  NumberSlots slots_;
};

/// The different nodes of one level: runs of words. A leaf block is two words.
class UniqueNodes {
 public:
  explicit UniqueNodes(MemoryBudget* memory) : words_(memory), starts_(memory), slots_(memory) {}

  /// Returns the index of the node's first word among all words. Throws Error if the words outgrow
  /// 32-bit pointers.
  std::uint32_t add(const std::uint32_t* node, std::size_t size) {
    if (slots_.is_full(starts_.size()))
      slots_.grow([this](const auto& add_number) {
        for (std::size_t i = 0; i < starts_.size(); ++i) {
          const std::size_t end = i + 1 < starts_.size() ? starts_[i + 1] : words_.size();
          add_number(starts_[i], hash_of(words_.data() + starts_[i], end - starts_[i]));
        }
      });
    std::uint32_t& slot = slots_.find(hash_of(node, size), [&](std::uint32_t start) {
      return std::equal(node, node + size, words_.data() + start,
                        words_.data() + std::min<std::size_t>(words_.size(), start + size));
    });
    if (slot != NumberSlots::kFree) return slot;
    if (words_.size() + size >= NumberSlots::kFree)
      throw Error(
          "the DAG is too large: its nodes have more words than 32-bit pointers can address");
    slot = static_cast<std::uint32_t>(words_.size());
    starts_.push_back(slot);
    words_.insert(words_.end(), node, node + size);
    return slot;
  }
  const CountedVector<std::uint32_t>& words() const { return words_; }

 private:
  CountedVector<std::uint32_t> words_, starts_;
  NumberSlots slots_;
};

}  // namespace voxdag
