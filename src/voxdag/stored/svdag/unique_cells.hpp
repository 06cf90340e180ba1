#pragma once
/// Numbers different cells in the order in which they are first met.
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <utility>

#include "voxdag/core/error.hpp"
#include "voxdag/core/number_table.hpp"

namespace voxdag {

/// Different values of cells of one level: leaf blocks, or keys of some words.
template <class T>
class UniqueCells {
 public:
  explicit UniqueCells(MemoryBudget* memory) : cells_(memory), table_(memory) {}

  /// Returns the cell's number. Throws OverMemory, and Error if there are 2^32 - 1 cells.
  std::uint32_t add(const T& cell) { return add(cell, hash_of(cell)); }
  /// As above, for a caller that knows hash_of(cell).
  std::uint32_t add(const T& cell, std::uint64_t hash) {
    const auto words = std::bit_cast<Words>(cell);
    return table_.find_or_add(
        hash, [&](std::uint32_t n) { return are_equal(std::bit_cast<Words>(cells_[n]), words); },
        [&] {
          if (cells_.size() == NumberSlots::kMaxNumbers)
            throw Error("the DAG is too large: a level has 2^32 different cells or more");
          cells_.push_back(cell);
          return static_cast<std::uint32_t>(cells_.size() - 1);
        });
  }
  static std::uint64_t hash_of(const T& cell) {
    const auto words = std::bit_cast<Words>(cell);
    return hash_words(words.data(), kWords);
  }
  /// Prefetches the slot that add() reads first. Worth it some dozens of calls before add().
  void prefetch(std::uint64_t hash) const { table_.prefetch(hash); }
  /// Prefetches the cell that add() compares first, once its slot is there.
  void prefetch_likely(std::uint64_t hash) const {
    const std::uint32_t number = table_.likely(hash);
    if (number != NumberSlots::kMaxNumbers) __builtin_prefetch(cells_.data() + number);
  }
  /// Returns the cells by their numbers.
  const CountedVector<T>& cells() const { return cells_; }
  /// Returns the cells by their numbers, and forgets them.
  CountedVector<T> take() { return std::move(cells_); }

 private:
  static constexpr int kWords = sizeof(T) / sizeof(std::uint32_t);
  using Words = std::array<std::uint32_t, kWords>;

  /// The operator of std::array calls memcmp().
  static bool are_equal(const Words& a, const Words& b) {
    std::uint32_t different = 0;
    for (std::size_t i = 0; i < a.size(); ++i) different |= a[i] ^ b[i];
    return different == 0;
  }

  CountedVector<T> cells_;
  NumberTable table_;
};

/// The different nodes of one level: runs of words. A leaf block is two words.
class UniqueNodes {
 public:
  explicit UniqueNodes(MemoryBudget* memory) : words_(memory), table_(memory) {}

  /// Returns the index of the node's first word among all words. Throws OverMemory, and Error if
  /// the words outgrow 32-bit pointers.
  std::uint32_t add(const std::uint32_t* node, std::size_t size) {
    return add(node, size, hash_words(node, static_cast<int>(size)));
  }
  /// As above, for a caller that knows the hash of the words.
  std::uint32_t add(const std::uint32_t* node, std::size_t size, std::uint64_t hash) {
    return table_.find_or_add(
        hash,
        [&](std::uint32_t start) {
          // If the first words are equal, the sizes are equal, so the other words may be read.
          const std::uint32_t* const stored = words_.data() + start;
          return stored[0] == node[0] && std::equal(node + 1, node + size, stored + 1);
        },
        [&] {
          const std::size_t start = words_.size();
          if (start + size >= NumberSlots::kMaxNumbers)
            throw Error(
                "the DAG is too large: its nodes have more words than 32-bit pointers can address");
          words_.insert(words_.end(), node, node + size);
          return static_cast<std::uint32_t>(start);
        });
  }
  /// See UniqueCells::prefetch().
  void prefetch(std::uint64_t hash) const { table_.prefetch(hash); }
  void prefetch_likely(std::uint64_t hash) const {
    const std::uint32_t start = table_.likely(hash);
    if (start != NumberSlots::kMaxNumbers) __builtin_prefetch(words_.data() + start);
  }
  const CountedVector<std::uint32_t>& words() const { return words_; }

 private:
  CountedVector<std::uint32_t> words_;
  NumberTable table_;
};

}  // namespace voxdag
