#include "voxdag/stored/attributes/encode_page.hpp"

#include <algorithm>
#include <cmath>

#include "voxdag/stored/attributes/fit_block.hpp"

namespace voxdag {
namespace {

constexpr int kUnits = kPageValues / kBlockUnit;

/// Appends numbers to a page.
class PageWriter {
 public:
  explicit PageWriter(EncodedPage& page) : page_(page) {}

  void add(std::uint64_t value, int bits) {
    write_bits(page_.words.data(), static_cast<std::uint64_t>(page_.bits), bits, value);
    page_.bits += bits;
  }

 private:
  EncodedPage& page_;
};

/// Merges the units of a page to blocks. Holds the sums of each.
class PageMerger {
 public:
  PageMerger(std::span<const Value8, kPageValues> values, const ValueMetric& metric) {
    for (int i = 0; i < kPageValues; ++i) {
      const ValueSums of_value = ValueSums::of(values[static_cast<std::size_t>(i)], metric);
      ValueSums& unit = sums_[static_cast<std::size_t>(i / kBlockUnit)];
      unit = i % kBlockUnit == 0 ? of_value : unit + of_value;
    }
    units_ = sums_;
  }

  /// Merges the two neighbours that save most cost, until every merge would add cost. A block is
  /// named by its first unit.
  void merge(const BlockEstimator& estimator) {
    for (std::size_t i = 0; i < kUnits; ++i) {
      next_[i] = i + 1;
      before_[i] = i - 1;  // not used for 0
      costs_[i] = estimator.cost(static_cast<int>(i) * kBlockUnit, sums_[i]);
    }
    saved_.fill(-1);
    for (std::size_t i = 0; i + 1 < kUnits; ++i) join(estimator, i);
    for (;;) {
      const std::size_t best = most_saved();
      if (saved_[best] < 0) return;
      const std::size_t gone = next_[best];
      sums_[best] += sums_[gone];
      costs_[best] = joined_costs_[best];
      saved_[gone] = -1;
      next_[best] = next_[gone];
      if (next_[best] < kUnits) before_[next_[best]] = best;
      join(estimator, best);
      if (best > 0) join(estimator, before_[best]);
    }
  }

  /// Calls use(first value, sums) for each block, in order.
  template <class Use>
  void for_each_block(const Use& use) const {
    for (std::size_t i = 0; i < kUnits; i = next_[i])
      use(static_cast<int>(i) * kBlockUnit, sums_[i]);
  }

  /// Returns the sums of the values from `begin` to `end` - 1, multiples of kBlockUnit.
  ValueSums sums_between(int begin, int end) const {
    ValueSums sums = units_[static_cast<std::size_t>(begin / kBlockUnit)];
    for (int i = begin / kBlockUnit + 1; i < end / kBlockUnit; ++i)
      sums += units_[static_cast<std::size_t>(i)];
    return sums;
  }

 private:
  /// Computes the cost that a merge of block `i` with the next one saves.
  void join(const BlockEstimator& estimator, std::size_t i) {
    saved_[i] = -1;
    const std::size_t other = next_[i];
    if (other >= kUnits) return;
    joined_costs_[i] = estimator.cost(static_cast<int>(i) * kBlockUnit, sums_[i] + sums_[other]);
    saved_[i] = costs_[i] + costs_[other] - joined_costs_[i];
  }

  /// Returns the block whose merge saves most; the first of several.
  std::size_t most_saved() const {
    float most = saved_[0];
    for (std::size_t i = 1; i < kUnits; ++i) most = std::max(most, saved_[i]);
    std::size_t best = 0;
    while (saved_[best] != most) ++best;
    return best;
  }

  std::array<ValueSums, kUnits> units_, sums_;
  std::array<std::size_t, kUnits> next_{}, before_{};
  std::array<float, kUnits> costs_{}, joined_costs_{}, saved_{};
};

/// Writes the blocks of a page.
class PageEncoder {
 public:
  PageEncoder(std::span<const Value8, kPageValues> values, const ValueMetric& metric,
              PagePrecision precision, const PageMerger& merger)
      : merger_(merger), fitter_(values, metric, precision) {}

  /// Calls use(block) for the fitted blocks, in order. Splits a block that must store each value by
  /// itself, as long as this saves cost.
  template <class Use>
  void for_each_fitted(const Use& use) const {
    std::array<FittedBlock, kUnits> blocks;
    merger_.for_each_block([&](int begin, const ValueSums& sums) {
      std::size_t count = 0;
      fit(begin, sums, blocks, count);
      for (std::size_t i = 0; i < count; ++i) use(blocks[i]);
    });
  }

  const BlockFitter& fitter() const { return fitter_; }

 private:
  /// Appends the blocks of values to `blocks`, and returns their cost.
  float fit(int begin, const ValueSums& sums, std::array<FittedBlock, kUnits>& blocks,
            std::size_t& count) const {
    const FittedBlock whole = fitter_.fit(begin, sums);
    const std::size_t first = count;
    if (whole.block.type == ValueBlock::kRaw && sums.count > kBlockUnit) {
      const int end = begin + sums.count;
      const int middle = begin + sums.count / (2 * kBlockUnit) * kBlockUnit;
      float parts = fit(begin, merger_.sums_between(begin, middle), blocks, count);
      parts += fit(middle, merger_.sums_between(middle, end), blocks, count);
      if (parts < whole.cost) return parts;
      count = first;
    }
    blocks[count++] = whole;
    return whole.cost;
  }

  const PageMerger& merger_;
  const BlockFitter fitter_;
};

}  // namespace

void ValueErrors::count(Value8 given, Value8 stored) {
  int sum = 0;
  for (int c = 0; c < 3; ++c) {
    const int d = int{given[c]} - int{stored[c]};
    sum += d * d;
  }
  squared += static_cast<std::uint64_t>(sum);
  absolute += static_cast<std::uint64_t>(256 * std::sqrt(static_cast<float>(sum)) + 0.5f);
}

EncodedPage encode_page(std::span<const Value8, kPageValues> values, const ValueMetric& metric,
                        PagePrecision precision, int given) {
  PageMerger merger(values, metric);
  merger.merge(BlockEstimator(values.data(), metric, precision));
  const PageEncoder encoder(values, metric, precision, merger);
  EncodedPage page;
  PageWriter writer(page);
  encoder.for_each_fitted([&](const FittedBlock& fitted) {
    writer.add(precision.pack_header(fitted.block), precision.header_bits());
    encoder.fitter().write(
        fitted, [&](std::uint64_t value, int bits) { writer.add(value, bits); },
        [&](int i, Value8 stored) {
          if (i < given) page.errors.count(values[static_cast<std::size_t>(i)], stored);
        });
  });
  return page;
}

}  // namespace voxdag
