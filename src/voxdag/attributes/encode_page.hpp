#pragma once
/// Compresses a page of values under an error bound.
///
/// After D. Dolonius, E. Sintorn, V. Kämpe and U. Assarsson, "Compressing Color Data for Voxelized
/// Surface Geometry", I3D 2017: values in depth-first order are split into blocks of any length,
/// each with two ends and weights of as few bits as the error bound allows. Neighbouring blocks
/// merge, those first that save most bits, as long as that saves bits.
#include <array>
#include <cstdint>
#include <span>

#include "voxdag/layout/value_pages.hpp"

namespace voxdag {

/// The measure of errors: the square root of the weighted mean of the channels' squared
/// differences.
struct ValueMetric {
  std::array<int, 3> weights{1, 1, 1};
  /// The largest error of a value, in steps of 8 bits, squared, times the sum of the weights.
  int bound = 0;

  int sum() const { return weights[0] + weights[1] + weights[2]; }
  /// Returns the squared error, times the sum of the weights.
  int error(Value8 a, Value8 b) const {
    int sum = 0;
    for (int c = 0; c < 3; ++c) {
      const int d = int{a[c]} - int{b[c]};
      sum += weights[static_cast<std::size_t>(c)] * d * d;
    }
    return sum;
  }
};

/// Makes a metric with this bound, in steps of 8 bits.
ValueMetric make_value_metric(std::array<int, 3> weights, double bound);

/// Returns the coarsest precision of ends that keeps the bound.
EndPrecision choose_precision(const ValueMetric& metric);

/// The most words that a page can take.
inline constexpr int kMostPageWords = 105;

/// How much the stored values differ from the given ones.
struct ValueErrors {
  std::uint64_t squared = 0;   ///< Sum of the squared differences of all channels.
  std::uint64_t absolute = 0;  ///< Sum of the distances of the values, in 1/256 steps of 8 bits.

  void count(Value8 given, Value8 stored);
  ValueErrors& operator+=(const ValueErrors& other) {
    squared += other.squared;
    absolute += other.absolute;
    return *this;
  }
};

/// A compressed page: `bits` bits from the lowest bit of each word up; the rest is zero.
struct EncodedPage {
  std::array<std::uint64_t, kMostPageWords> words{};
  int bits = 0;
  ValueErrors errors;
};

/// Compresses the values. The error of each is at most the bound. Depends on the arguments alone.
EncodedPage encode_page(std::span<const Value8, kPageValues> values, const ValueMetric& metric,
                        EndPrecision precision);

}  // namespace voxdag
