#pragma once
/// Compresses values that come in ranges, in any order and on many threads.
#include <memory>
#include <mutex>
#include <span>
#include <unordered_map>
#include <vector>

#include "voxdag/attributes/encode_page.hpp"
#include "voxdag/core/memory_budget.hpp"

namespace voxdag {

/// Holds the compressed pages, and the values of pages that are not complete.
class ValueEncoder {
 public:
  /// Expects `values` values. Counts its memory in `memory`; null: no limit.
  ValueEncoder(std::uint64_t values, const ValueMetric& metric, MemoryBudget* memory);

  /// Takes the values from number `first` on. Thread-safe. Each value must come once. Compresses
  /// the pages that are complete. Throws OverMemory.
  void add(std::uint64_t first, std::span<const Value8> values);

  /// Returns all pages. Every value must have come. They depend on the values alone. Throws
  /// OverMemory.
  ValuePages finish();

  /// Returns the errors of the pages that are compressed.
  const ValueErrors& errors() const { return errors_; }

 private:
  struct OpenPage {
    std::array<Value8, kPageValues> values;
    std::uint64_t count = 0;
  };
  /// The place of a page in `chunks_`.
  struct PagePlace {
    std::uint32_t chunk = 0;
    std::uint16_t word = 0, bytes = 0;
  };
  static constexpr std::size_t kChunkWords = 1 << 15;

  void add_part(std::uint64_t first, std::span<const Value8> values);
  void keep(std::uint64_t page, const EncodedPage& encoded);

  const std::uint64_t values_;
  const ValueMetric metric_;
  const EndPrecision precision_;
  MemoryBudget* memory_;
  std::mutex mutex_;
  std::unordered_map<std::uint64_t, OpenPage> open_;
  CountedVector<PagePlace> places_;
  std::vector<CountedVector<std::uint64_t>> chunks_;
  ValueErrors errors_;
};

}  // namespace voxdag
