#pragma once
/// Chooses the context trees of a compact DAG.
#include <array>
#include <vector>

#include "voxdag/core/parallel/work.hpp"
#include "voxdag/stored/compact/coded_symbols.hpp"
#include "voxdag/stored/compact/compact_svdag.hpp"
#include "voxdag/stored/compact/numbered_nodes.hpp"

namespace voxdag {

using CompactTrees = std::array<ContextTree, kCompactSymbols>;

/// Returns the trees and frequencies of all symbols. The tree of kUnitBits is one table without
/// symbols, because the lengths are not known yet. `most_tables` limits the tables of cell masks,
/// half of it those of leaf masks, and an eighth those of other symbols. If the budget has room,
/// `coded` gets the symbols of all units, then those of all shared bricks, then those of the nodes
/// above the units. Throws OverMemory and Cancelled.
CompactTrees choose_trees(const NumberedNodes& nodes, int most_tables, Work work,
                          CodedSymbols& coded);

/// Counts the symbols of one context tree by table.
class SymbolCounts {
 public:
  explicit SymbolCounts(std::size_t tables) : counts_(tables) {}

  void add(std::uint32_t table, std::uint32_t symbol) { ++counts_[table][symbol]; }
  void add(const SymbolCounts& other) {
    for (std::size_t t = 0; t < counts_.size(); ++t)
      for (std::size_t s = 0; s < 256; ++s) counts_[t][s] += other.counts_[t][s];
  }
  /// Gives the tree the frequencies of these counts, and prepares it for reading.
  void set_frequencies(ContextTree& tree) const;

 private:
  std::vector<std::array<std::uint64_t, 256>> counts_;
};

}  // namespace voxdag
