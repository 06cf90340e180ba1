#pragma once
/// Compresses values that many threads give in ranges, in any order.
#include <atomic>
#include <functional>
#include <mutex>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "voxdag/core/memory_budget.hpp"
#include "voxdag/stored/attributes/join_page.hpp"

namespace voxdag {

/// Compresses each page as soon as all its values have come. Holds the compressed pages, and the
/// values of incomplete pages.
class ValueEncoder {
 public:
  /// Expects `values` values. Counts its memory in `memory`.
  ValueEncoder(std::uint64_t values, const ValueMetric& metric, MemoryBudget* memory);

  /// The same, for values of which some are copied. `precision` is joined_precision() of all
  /// sources of copies. The metric's bound is 0.
  ValueEncoder(std::uint64_t values, const ValueMetric& metric, PagePrecision precision,
               MemoryBudget* memory);

  /// Takes the values from number `first` on. Every value must be in exactly one call. Thread-safe.
  /// Throws OverMemory.
  void add(std::uint64_t first, std::span<const Value8> values);

  /// Returns whether a page rounds values that were copied (join_page.hpp).
  bool rounds_copies() const { return rounds_copies_; }
  /// Returns whether an end can be this value.
  bool can_store(Value8 value) const;

  /// Takes `count` values that are those of `from` from number `from_first` on. `from` must outlive
  /// the call of finish(). Otherwise like add().
  void copy(std::uint64_t first, std::uint64_t count, const ValuePagesView& from,
            std::uint64_t from_first);

  /// Returns all pages, which depend on the values alone. Every value must have come. Does not
  /// count the result once it has returned. Throws OverMemory.
  ValuePages finish();

  /// Returns the errors of all compressed values.
  const ValueErrors& errors() const { return errors_; }

 private:
  struct OpenPage {
    std::array<Value8, kPageValues> values;
    std::vector<CopiedValues> copies;
    std::uint64_t count = 0;
  };
  using OpenPages = std::unordered_map<std::uint64_t, OpenPage, std::hash<std::uint64_t>,
                                       std::equal_to<std::uint64_t>,
                                       CountedAllocator<std::pair<const std::uint64_t, OpenPage>>>;
  /// The place of a compressed page in `chunks_`.
  struct PagePlace {
    std::uint32_t chunk = 0;
    std::uint16_t word = 0;   // the page's first word in the chunk
    std::uint16_t bytes = 0;  // size of the page
  };
  static constexpr std::size_t kChunkWords = 1 << 15;

  /// Calls set(page) for the page of `count` values from number `first` on, and compresses it if it
  /// is complete.
  template <class Set>
  void add_part(std::uint64_t first, std::uint64_t count, const Set& set);
  bool copies() const { return precision_.unit() == 1; }
  void keep(std::uint64_t page, const EncodedPage& encoded);

  const std::uint64_t values_;
  const ValueMetric metric_;
  const PagePrecision precision_;
  MemoryBudget* memory_;
  std::mutex mutex_;
  OpenPages open_;  // by page
  CountedVector<PagePlace> places_;
  std::vector<CountedVector<std::uint64_t>> chunks_;
  ValueErrors errors_;
  std::atomic<bool> rounds_copies_ = false;
};

}  // namespace voxdag
