#pragma once
/// Finds the frequency tables of many symbols at once.
///
/// A walk through a context tree waits for one load after the other. A batch of symbols does eight
/// walks at the same time, so that the loads of one fill the waits of the others.
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "voxdag/stored/compact/compact_svdag.hpp"

namespace voxdag {

/// A symbol, or a number that has no context.
struct BatchedSymbol {
  std::uint64_t features = 0;
  std::uint32_t value = 0;
  /// The table of a symbol's tree. Until find_tables() is called, the first step of the walk to it.
  std::uint32_t table = 0;
  std::uint8_t kind = 0;  ///< A CompactSymbol, or kRaw.
  std::uint8_t bits = 0;  ///< The number of bits of a number without context.

  static constexpr std::uint8_t kRaw = kCompactSymbols;
};

/// The nodes of all context trees.
class TableFinder {
 public:
  explicit TableFinder(std::span<const ContextTree, kCompactSymbols> trees) {
    for (std::size_t s = 0; s < trees.size(); ++s) {
      const auto begin = static_cast<std::uint32_t>(nodes_.size());
      for (const std::uint32_t node : trees[s].nodes)
        nodes_.push_back((node & kLeafNode) != 0 ? node : node + (begin << 8));
      roots_[s] = nodes_[begin];
    }
    // A finished walk reads the nodes that its table's number and the number after it select.
    nodes_.push_back(kLeafNode);
  }

  /// Returns the first step of the walk through a tree.
  std::uint32_t root(CompactSymbol symbol) const { return roots_[symbol]; }
  static constexpr std::uint32_t kRawRoot = kLeafNode;

  /// Finds the tables of all symbols.
  void find_tables(std::span<BatchedSymbol> symbols) const {
    std::size_t i = 0;
    for (; i + kLanes <= symbols.size(); i += kLanes) find<kLanes>(symbols.data() + i);
    for (; i < symbols.size(); ++i) find<1>(symbols.data() + i);
  }

 private:
  static constexpr std::size_t kLanes = 8;

  template <std::size_t N>
  void find(BatchedSymbol* symbols) const {
    std::array<std::uint32_t, N> steps;
    for (std::size_t k = 0; k < N; ++k) steps[k] = symbols[k].table;
    const std::uint32_t* nodes = nodes_.data();
    for (;;) {
      std::uint32_t finished = kLeafNode;
      for (std::size_t k = 0; k < N; ++k) finished &= steps[k];
      if (finished != 0) break;
      for (std::size_t k = 0; k < N; ++k) {
        const std::uint32_t step = steps[k];
        const std::uint32_t next =
            nodes[(step >> 8) +
                  static_cast<std::uint32_t>(symbols[k].features >> (step & 63u) & 1u)];
        // A branch would often be predicted wrongly.
        const std::uint32_t is_finished = 0u - (step / kLeafNode & 1u);
        steps[k] = next ^ ((next ^ step) & is_finished);
      }
    }
    for (std::size_t k = 0; k < N; ++k) symbols[k].table = steps[k] >> 8;
  }

  std::vector<std::uint32_t> nodes_;
  std::array<std::uint32_t, kCompactSymbols> roots_;
};

/// Collects symbols. It is a sink of unit_symbols.hpp.
class SymbolBatch {
 public:
  explicit SymbolBatch(const TableFinder& finder) : finder_(&finder) {}

  void symbol(CompactSymbol symbol, std::uint64_t features, std::uint32_t value) {
    symbols_.push_back({features, value, finder_->root(symbol), static_cast<std::uint8_t>(symbol)});
  }
  void raw(std::uint32_t value, int bits) {
    symbols_.push_back(
        {0, value, TableFinder::kRawRoot, BatchedSymbol::kRaw, static_cast<std::uint8_t>(bits)});
  }
  std::size_t size() const { return symbols_.size(); }

  /// Calls use(BatchedSymbol) for the symbols in their order, and empties the batch.
  template <class Use>
  void flush(const Use& use) {
    finder_->find_tables(symbols_);
    for (const BatchedSymbol& symbol : symbols_) use(symbol);
    symbols_.clear();
  }

 private:
  const TableFinder* finder_;
  std::vector<BatchedSymbol> symbols_;
};

}  // namespace voxdag
