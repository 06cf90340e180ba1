#pragma once
/// A context tree: it chooses the frequency table that codes a symbol by the symbol's features.
///
/// Source of the idea: J. Rissanen, "A universal data compression system", IEEE Transactions on
/// Information Theory 1983. The features of a symbol are up to 64 bits that the reader knows before
/// it reads the symbol. An inner node of the tree tests one bit; a leaf is a table.
///
///   nodes   inner node: the first of its two children << 8 | feature
///           leaf:       table << 8 | kLeafNode
///           Node 0 is the root. A depth-first walk gives the order of the other nodes, two
///           children of a node at a time, and of the tables.
///
/// prepare() makes what reading needs:
///
///   starts  for each value of the features 52 to 59: the first node on the way from the root that
///           tests none of them. So walks through trees of masks skip some levels.
///   steps   the nodes; a leaf has its table's place in `entries` << 8 | kLeafNode
///   entries all tables. A table is the number of its entries, then the entries:
///           symbol | start << 8 | (frequency - 1) << 20
///
/// The entries of a table are in the order of decreasing frequency, and equal frequencies in the
/// order of the symbols. Their intervals [start, start + frequency) fill [0, 4096) in this order.
#include <array>
#include <cstdint>
#include <vector>

#include "voxdag/stored/compact/symbol_coder.hpp"

namespace voxdag {

inline constexpr std::uint32_t kLeafNode = 0x80;
inline constexpr int kFirstStartFeature = 52, kStartBits = 8;
inline constexpr int kMaxTables = 4096;  ///< The largest number of tables of one tree.

/// A view for kernels.
struct ContextTreeView {
  const std::uint32_t* starts = nullptr;
  const std::uint32_t* steps = nullptr;
  const std::uint32_t* entries = nullptr;

  /// Reads a symbol that has these features.
  VOXDAG_HD std::uint32_t read(SymbolReader& reader, std::uint64_t features) const {
    constexpr std::uint64_t kStarts = (1u << kStartBits) - 1;
    std::uint32_t node = steps[starts[features >> kFirstStartFeature & kStarts]];
    while ((node & kLeafNode) == 0)
      node = steps[(node >> 8) + static_cast<std::uint32_t>(features >> (node & 63u) & 1u)];
    const std::uint32_t* table = entries + (node >> 8);
    const std::uint32_t* const last = table + table[0];
    const std::uint32_t* entry = table + 1;
    const std::uint32_t unit = reader.unit(), code = reader.code();
    while (entry != last && code >= ((*entry >> 8 & 0xFFFu) + (*entry >> 20) + 1) * unit) ++entry;
    reader.take(*entry >> 8 & 0xFFFu, (*entry >> 20) + 1);
    return *entry & 0xFFu;
  }
};

/// The weights of the symbols 0 to 255 of a table, as codes. Code 0: the symbol does not occur.
/// Code c from 1 to 4: weight c. Larger c: weight (4 + (c - 1) % 4) << ((c - 1) / 4 - 1).
using WeightCodes = std::array<std::uint8_t, 256>;
inline constexpr std::uint8_t kMaxWeightCode = 45;

/// The frequencies of a table's symbols. They add up to 4096, or all are zero.
using Frequencies = std::array<std::uint16_t, 256>;

/// Returns the frequencies for weights. If n symbols occur, a symbol's frequency is
/// 1 + floor(weight * (4096 - n) / sum of weights). The first of the most frequent symbols also
/// gets the rest of 4096.
Frequencies frequencies_of(const WeightCodes& weights);

/// The interval [start, start + frequency) of a symbol of a table; the frequency is 0 if the symbol
/// does not occur.
struct SymbolInterval {
  std::uint16_t start = 0, frequency = 0;
};

/// Returns the intervals of all symbols.
std::array<SymbolInterval, 256> intervals_of(const WeightCodes& weights);

/// Returns weights for the counts of a table's symbols. The counts are the weights if their sum is
/// at most 4096; otherwise they are scaled to that sum. Weights keep three significant bits, and
/// are at least 1 for each symbol that occurs.
WeightCodes weights_for(const std::array<std::uint32_t, 256>& counts);

/// A context tree in memory.
struct ContextTree {
  std::vector<std::uint32_t> nodes{kLeafNode};
  std::vector<WeightCodes> weights{1};  ///< A table whose weights are all 0 is not used.

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
