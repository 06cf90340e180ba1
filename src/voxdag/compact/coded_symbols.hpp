#pragma once
/// The symbols of many nodes with their tables, kept from the pass that counts them for the pass
/// that writes them.
#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "voxdag/compact/symbol_batch.hpp"
#include "voxdag/core/memory_budget.hpp"

namespace voxdag {

/// A symbol is one word: table | kind << 12 | value << 16. A number without context is two words:
/// kRaw << 12 | bits << 16, then the number.
class CodedSymbols {
 public:
  static constexpr std::size_t kPart = 1024;  ///< Nodes of a part.

  struct Part {
    std::vector<std::uint32_t> words;
    std::vector<std::uint32_t> ends;  ///< The words of the nodes up to each one, of the part's.
    MemoryReservation memory;

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

  /// Makes the parts for `nodes` nodes, if the memory is there: it may take a quarter of what is
  /// left of the budget, which may be null. About `words` words are needed.
  void begin(std::uint64_t nodes, std::uint64_t words, MemoryBudget* budget) {
    if (budget != nullptr &&
        words * 4 > (budget->limit() - std::min(budget->limit(), budget->used())) / 4)
      return;
    parts_.resize((nodes + kPart - 1) / kPart);
  }
  bool are_kept() const { return !parts_.empty(); }
  Part& part(std::size_t i) { return parts_[i]; }
  void clear() { parts_.clear(); }

  /// Returns the words of node i.
  std::span<const std::uint32_t> of(std::size_t i) const {
    const Part& part = parts_[i / kPart];
    const std::size_t at = i % kPart, begin = at == 0 ? 0 : part.ends[at - 1];
    return std::span(part.words).subspan(begin, part.ends[at] - begin);
  }

 private:
  std::vector<Part> parts_;
};

}  // namespace voxdag
