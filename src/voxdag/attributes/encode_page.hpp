#pragma once
/// Compresses a page of values under an error bound.
///
/// Source: D. Dolonius, E. Sintorn, V. Kämpe and U. Assarsson, "Compressing Color Data for
/// Voxelized Surface Geometry", I3D 2017. Blocks of values in depth-first order have two ends, and
/// weights of as few bits as the error bound allows. A page begins as blocks of 4 values. In each
/// step, the two neighbours merge that save most bits, until every merge would cost bits.
#include <array>
#include <cstdint>
#include <span>

#include "voxdag/layout/value_pages.hpp"

namespace voxdag {

/// Measures errors and bounds them. The error of a value is the square root of the weighted mean of
/// its channels' squared differences, in steps of 8 bits.
struct ValueMetric {
  std::array<int, 3> weights{1, 1, 1};
  int bound = 0;  ///< The largest error(): 0 to 65025 times the sum of the weights.

  int sum() const { return weights[0] + weights[1] + weights[2]; }
  /// Returns the square of the error, times the sum of the weights.
  int error(Value8 a, Value8 b) const {
    int sum = 0;
    for (int c = 0; c < 3; ++c) {
      const int d = int{a[c]} - int{b[c]};
      sum += weights[static_cast<std::size_t>(c)] * d * d;
    }
    return sum;
  }
};

/// Makes a metric whose largest error is `bound`, 0 to 255.
ValueMetric make_value_metric(std::array<int, 3> weights, double bound);

/// Returns the coarsest precision at which an end can stand for every value within the bound.
EndPrecision choose_precision(const ValueMetric& metric);

/// The most words of a page: all its blocks have the least length and store each value by itself.
inline constexpr int kMostPageWords =
    kPageValues / kBlockUnit * ValueBlock{ValueBlock::kRaw, kBlockUnit}.bits(24) / 64;
static_assert(kMostPageWords == 105);

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
  std::array<std::uint64_t, kMostPageWords> words{};  ///< From bit `bits` on, all bits are zero.
  int bits = 0;
  ValueErrors errors;
};

/// Compresses the values. The error of each is at most the bound. EncodedPage::errors has the
/// differences of the first `given` values; the others only fill the page up. The result depends on
/// the arguments alone.
EncodedPage encode_page(std::span<const Value8, kPageValues> values, const ValueMetric& metric,
                        EndPrecision precision, int given = kPageValues);

}  // namespace voxdag
