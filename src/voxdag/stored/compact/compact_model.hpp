#pragma once
/// Chooses the context trees of a compact DAG.
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "voxdag/core/memory_budget.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/stored/compact/compact_svdag.hpp"
#include "voxdag/stored/compact/numbered_nodes.hpp"
#include "voxdag/stored/compact/symbol_batch.hpp"

namespace voxdag {

/// Keeps the symbols of many nodes, with their tables, from the pass that counts them to the pass
/// that writes them. A symbol is one word: table | kind << 12 | value << 16. A number without
/// context is two words: kRaw << 12 | bits << 16, then the number.
class CodedSymbols {
 public:
  static constexpr std::size_t kPart = 1024;  ///< Nodes of a part.

  struct Part {
    std::vector<std::uint32_t> words;
    std::vector<std::uint32_t> ends;  ///< For each node of the part: the word behind its last one.
    MemoryReservation memory;

    std::uint64_t bytes() const { return (words.capacity() + ends.capacity()) * sizeof words[0]; }

    /// Appends a symbol whose table is known.
    void put(const BatchedSymbol& symbol) {
      const std::uint32_t kind = std::uint32_t{symbol.kind} << 12;
      if (symbol.kind == BatchedSymbol::kRaw) {
        words.push_back(kind | std::uint32_t{symbol.bits} << 16);
        words.push_back(symbol.value);
      } else {
        words.push_back(symbol.table | kind | symbol.value << 16);
      }
    }
  };

  /// Makes the parts for `nodes` nodes with about `words` words, if these take at most a quarter of
  /// what is left of the budget. Without a budget, makes them.
  void begin(std::uint64_t nodes, std::uint64_t words, MemoryBudget* budget) {
    if (budget != nullptr &&
        words * 4 > (budget->limit() - std::min(budget->limit(), budget->used())) / 4)
      return;
    parts_.resize((nodes + kPart - 1) / kPart);
  }
  bool are_kept() const { return !parts_.empty(); }
  Part& part(std::size_t i) { return parts_[i]; }
  void clear() { parts_.clear(); }

  /// Calls use(BatchedSymbol) for the symbols of node i in their order.
  template <class Use>
  void visit(std::size_t i, const Use& use) const {
    const Part& part = parts_[i / kPart];
    const std::size_t node = i % kPart;
    for (std::size_t at = node == 0 ? 0 : part.ends[node - 1]; at < part.ends[node]; ++at) {
      const std::uint32_t word = part.words[at];
      BatchedSymbol symbol;
      symbol.kind = static_cast<std::uint8_t>(word >> 12 & 15u);
      if (symbol.kind == BatchedSymbol::kRaw) {
        symbol.bits = static_cast<std::uint8_t>(word >> 16);
        symbol.value = part.words[++at];
      } else {
        symbol.table = word & 0xFFFu;
        symbol.value = word >> 16;
      }
      use(symbol);
    }
  }

 private:
  std::vector<Part> parts_;
};

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
