#pragma once
/// Compresses a page of values under an error bound.
///
/// Source: D. Dolonius, E. Sintorn, V. Kämpe and U. Assarsson, "Compressing Color Data for
/// Voxelized Surface Geometry", I3D 2017. Blocks of values in depth-first order have two ends, and
/// weights of few bits. A page begins as blocks of 4 values. In each step, the two neighbours merge
/// that save most cost, until every merge would add cost. Unlike in the paper, the cost of a block
/// is its bits plus the price of its squared errors (ValueMetric::price()), as in rate-distortion
/// optimisation. Merges compare costs that are estimated from sums (estimate_block.hpp); only the
/// blocks of the result are fitted to their values (fit_block.hpp).
#include <array>
#include <cstdint>
#include <span>

#include "voxdag/stored/attributes/value_metric.hpp"

namespace voxdag {

/// The most words of a page: blocks of 4 values store each value by itself.
inline constexpr int kMaxPageWords =
    kPageValues / kBlockUnit * PagePrecision{7}.bits_of({ValueBlock::kRaw, kBlockUnit}) / 64;
static_assert(kMaxPageWords == 107);

/// The differences between the given and the stored values.
struct ValueErrors {
  std::uint64_t squared = 0;   ///< Sum of the squared differences of all channels.
  std::uint64_t absolute = 0;  ///< Sum of the distances, in 1/256 of a step of 8 bits.

  /// Adds the difference of one value.
  void count(Value8 given, Value8 stored);
  ValueErrors& operator+=(const ValueErrors& other) {
    squared += other.squared;
    absolute += other.absolute;
    return *this;
  }
};

/// A compressed page.
struct EncodedPage {
  std::array<std::uint64_t, kMaxPageWords> words{};  ///< From bit `bits` on, all bits are zero.
  int bits = 0;
  ValueErrors errors;
  bool rounds_copies = false;  ///< Copied values are rounded: see join_page().
};

/// Compresses the values. The error of each is at most the bound. EncodedPage::errors has the
/// differences of the first `given` values; the others only fill the page up. The result depends on
/// the arguments alone.
EncodedPage encode_page(std::span<const Value8, kPageValues> values, const ValueMetric& metric,
                        PagePrecision precision, int given = kPageValues);

}  // namespace voxdag
