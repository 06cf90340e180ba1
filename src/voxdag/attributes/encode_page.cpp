#include "voxdag/attributes/encode_page.hpp"

#include <cmath>

#include "voxdag/attributes/fit_block.hpp"

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

/// The blocks of a page while they merge.
class PageMerger {
 public:
  explicit PageMerger(const BlockFitter& fitter) : fitter_(fitter) {
    for (int i = 0; i < kUnits; ++i)
      blocks_[static_cast<std::size_t>(i)] = fitter.fit(i * kBlockUnit, (i + 1) * kBlockUnit);
    count_ = kUnits;
    for (std::size_t i = 0; i + 1 < count_; ++i) join(i);
  }

  /// Merges the two neighbours that save most bits, until every merge would cost bits.
  void merge() {
    for (;;) {
      std::size_t best = count_;
      int most = -1;
      for (std::size_t i = 0; i + 1 < count_; ++i) {
        const int saved = blocks_[i].bits + blocks_[i + 1].bits - joined_[i].bits;
        if (saved > most) {
          most = saved;
          best = i;
        }
      }
      if (best == count_) return;
      blocks_[best] = joined_[best];
      --count_;
      for (std::size_t i = best + 1; i < count_; ++i) blocks_[i] = blocks_[i + 1];
      for (std::size_t i = best; i + 1 < count_; ++i) joined_[i] = joined_[i + 1];
      if (best > 0) join(best - 1);
      if (best + 1 < count_) join(best);
    }
  }

  std::span<const FittedBlock> blocks() const { return {blocks_.data(), count_}; }

 private:
  void join(std::size_t i) { joined_[i] = fitter_.fit(blocks_[i].begin, blocks_[i + 1].end()); }

  const BlockFitter& fitter_;
  std::size_t count_ = 0;
  std::array<FittedBlock, kUnits> blocks_, joined_;  // joined_[i]: blocks i and i + 1 as one
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

ValueMetric make_value_metric(std::array<int, 3> weights, double bound) {
  ValueMetric metric;
  metric.weights = weights;
  metric.bound = static_cast<int>(std::floor(bound * bound * metric.sum() + 1e-9));
  return metric;
}

EndPrecision choose_precision(const ValueMetric& metric) {
  for (int code = 0; code < 3; ++code) {
    int worst = 0;
    for (int c = 0; c < 3; ++c) {
      // The values of neighbouring ends differ by at most this step.
      const int step = (1 << (8 - EndPrecision{code}.channel_bits(c))) + 1;
      worst += metric.weights[static_cast<std::size_t>(c)] * (step / 2) * (step / 2);
    }
    if (worst <= metric.bound) return {code};
  }
  return {3};
}

EncodedPage encode_page(std::span<const Value8, kPageValues> values, const ValueMetric& metric,
                        EndPrecision precision, int given) {
  const BlockFitter fitter(values, metric, precision);
  PageMerger merger(fitter);
  merger.merge();
  EncodedPage page;
  PageWriter writer(page);
  for (const FittedBlock& fitted : merger.blocks()) {
    writer.add(fitted.block.pack(), ValueBlock::kHeaderBits);
    fitter.write(
        fitted, [&](std::uint64_t value, int bits) { writer.add(value, bits); },
        [&](int i, Value8 stored) {
          if (i < given) page.errors.count(values[static_cast<std::size_t>(i)], stored);
        });
  }
  return page;
}

}  // namespace voxdag
