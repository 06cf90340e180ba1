#pragma once
/// A context tree: chooses the frequency table that codes a symbol from what the reader knows.
///
/// Source of the idea: J. Rissanen, "A universal data compression system", IEEE Transactions on
/// Information Theory 1983. What the reader knows about a symbol is a number of up to 64 bits, its
/// features. An inner node of the tree tests one of them; a leaf is a table of frequencies.
///
///   nodes     inner node: the first of its two children << 8 | feature
///             leaf:       table << 8 | kLeafNode
///             Node 0 is the root. Children follow in the order in which a depth-first walk meets
///             their parents; so do the numbers of the tables.
///   entries   symbol | start << 8 | (frequency - 1) << 20; those of a table are in the order of
///             decreasing frequency (equal frequencies: of increasing symbols), and their
///             intervals [start, start + frequency) fill [0, 4096) in this order
///   buckets   of each table 64 bytes: the entry that holds the slot 64 * i, for a quick start
#include <array>
#include <cstdint>
#include <vector>

#include "voxdag/layout/compact/symbol_coder.hpp"

namespace voxdag {

inline constexpr std::uint32_t kLeafNode = 0x80;
inline constexpr int kBucketBits = 6;
inline constexpr int kMostTables = 4096;  ///< The largest number of tables of one tree.

/// A view for kernels.
struct ContextTreeView {
  const std::uint32_t* nodes = nullptr;
  const std::uint32_t* table_begin = nullptr;  ///< The first entry of each table.
  const std::uint32_t* entries = nullptr;
  const std::uint8_t* buckets = nullptr;

  /// Returns the table for `features`.
  VOXDAG_HD std::uint32_t table(std::uint64_t features) const {
    std::uint32_t node = nodes[0];
    while ((node & kLeafNode) == 0)
      node = nodes[(node >> 8) + static_cast<std::uint32_t>(features >> (node & 63u) & 1u)];
    return node >> 8;
  }

  /// Reads a symbol that has these features.
  VOXDAG_HD std::uint32_t read(SymbolReader& reader, std::uint64_t features) const {
    const std::uint32_t t = table(features);
    const std::uint32_t slot = reader.slot();
    const std::uint32_t* entry = entries + table_begin[t] +
                                 buckets[t << kBucketBits | slot >> (kFrequencyBits - kBucketBits)];
    for (;; ++entry) {
      const std::uint32_t start = *entry >> 8 & 0xFFFu, frequency = (*entry >> 20) + 1;
      if (slot - start >= frequency) continue;
      reader.take(start, frequency);
      return *entry & 0xFFu;
    }
  }
};

/// The weights of the symbols 0 to 255 of a table, as codes. Code 0 stands for a symbol that does
/// not occur, c = 1 to 4 for the weight c, and a larger c for (4 + (c - 1) % 4) << ((c - 1) / 4 -
/// 1).
using WeightCodes = std::array<std::uint8_t, 256>;
inline constexpr std::uint8_t kMostWeightCode = 45;

/// The frequencies of a table's symbols. They add up to 4096, or all are zero.
using Frequencies = std::array<std::uint16_t, 256>;

/// Returns the frequencies for weights. If n symbols occur, their frequencies are 1 + floor(weight
/// * (4096 - n) / sum of weights); the first of the most frequent symbols also gets what is left of
/// 4096.
Frequencies frequencies_of(const WeightCodes& weights);

/// Returns weights in proportion to the counts, of three significant bits, at least 1 for each
/// symbol that occurs.
WeightCodes weights_for(const std::array<std::uint32_t, 256>& counts);

/// A tree in memory.
struct ContextTree {
  std::vector<std::uint32_t> nodes{kLeafNode};
  std::vector<WeightCodes> weights{1};  ///< Of each table. All zero: a table that is not used.

  /// What reading needs; made from `weights` by prepare().
  std::vector<std::uint32_t> table_begin, entries;
  std::vector<std::uint8_t> buckets;

  void prepare();
  std::size_t tables() const { return weights.size(); }
  ContextTreeView view() const {
    return {nodes.data(), table_begin.data(), entries.data(), buckets.data()};
  }
  /// Returns the bytes that a reader holds.
  std::uint64_t bytes() const {
    return (nodes.size() + table_begin.size() + entries.size()) * 4 + buckets.size();
  }
};

}  // namespace voxdag
