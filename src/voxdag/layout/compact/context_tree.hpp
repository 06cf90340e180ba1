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
/// For reading, prepare() makes
///
///   starts    for each value of the features 52 to 59 the first node that tests another one, so
///   that
///             a walk through a tree of masks begins some levels below the root
///   steps     the nodes, whose leaves have the place of the table in `tables` << 8 | kLeafNode
///   tables    of each table, side by side for few cache misses: 16 bytes, byte i the entry that
///   holds
///             the slot 256 * i; then the entries, symbol | start << 8 | (frequency - 1) << 20, in
///             the order of decreasing frequency (equal frequencies: of increasing symbols). Their
///             intervals [start, start + frequency) fill [0, 4096) in this order.
#include <array>
#include <cstdint>
#include <vector>

#include "voxdag/layout/compact/symbol_coder.hpp"

namespace voxdag {

inline constexpr std::uint32_t kLeafNode = 0x80;
inline constexpr int kBucketBits = 4;
inline constexpr int kBucketWords = (1 << kBucketBits) / 4;
inline constexpr int kFirstStartFeature = 52, kStartBits = 8;
inline constexpr int kMostTables = 4096;  ///< The largest number of tables of one tree.

/// A view for kernels.
struct ContextTreeView {
  const std::uint32_t* starts = nullptr;
  const std::uint32_t* steps = nullptr;
  const std::uint32_t* tables = nullptr;

  /// Reads a symbol that has these features.
  VOXDAG_HD std::uint32_t read(SymbolReader& reader, std::uint64_t features) const {
    constexpr std::uint64_t kStarts = (1u << kStartBits) - 1;
    std::uint32_t node = steps[starts[features >> kFirstStartFeature & kStarts]];
    while ((node & kLeafNode) == 0)
      node = steps[(node >> 8) + static_cast<std::uint32_t>(features >> (node & 63u) & 1u)];
    const std::uint32_t* table = tables + (node >> 8);
    const std::uint32_t slot = reader.slot();
    const std::uint32_t bucket = slot >> (kFrequencyBits - kBucketBits);
    const std::uint32_t* entry =
        table + kBucketWords + (table[bucket >> 2] >> (8 * (bucket & 3u)) & 0xFFu);
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

/// The interval [start, start + frequency) of a symbol of a table; the frequency is 0 if the symbol
/// does not occur.
struct SymbolInterval {
  std::uint16_t start = 0, frequency = 0;
};

/// Returns the intervals of all symbols.
std::array<SymbolInterval, 256> intervals_of(const WeightCodes& weights);

/// Returns weights in proportion to the counts, of three significant bits, at least 1 for each
/// symbol that occurs.
WeightCodes weights_for(const std::array<std::uint32_t, 256>& counts);

/// A tree in memory.
struct ContextTree {
  std::vector<std::uint32_t> nodes{kLeafNode};
  std::vector<WeightCodes> weights{1};  ///< Of each table. All zero: a table that is not used.

  std::vector<std::uint32_t> starts, steps, entries;  ///< Made by prepare(), for reading.

  /// Makes what reading needs from `nodes` and `weights`.
  void prepare();
  std::size_t tables() const { return weights.size(); }
  /// Returns the table for `features`.
  std::uint32_t table(std::uint64_t features) const {
    std::uint32_t node = nodes[0];
    while ((node & kLeafNode) == 0) node = nodes[(node >> 8) + (features >> (node & 63u) & 1u)];
    return node >> 8;
  }
  ContextTreeView view() const { return {starts.data(), steps.data(), entries.data()}; }
};

}  // namespace voxdag
