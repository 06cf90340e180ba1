#pragma once
/// Measures and bounds errors of stored values, and gives them a price in bits.
#include <array>
#include <cstdint>

#include "voxdag/stored/attributes/value_pages.hpp"

namespace voxdag {

/// Measures errors and bounds them. The error of a value is the square root of the weighted mean of
/// its channels' squared differences, in steps of 8 bits.
struct ValueMetric {
  std::array<int, 3> weights{1, 1, 1};
  int bound = 0;  ///< The largest error(): 0 to 65025 times the sum of the weights.

  /// The bits that the encoder pays to avoid an error as large as the bound. It pays for smaller
  /// errors in proportion to their squares, so that most are less than half of the bound.
  static constexpr float kBoundPrice = 8;

  constexpr int sum() const { return weights[0] + weights[1] + weights[2]; }
  /// Returns the square of the error, times the sum of the weights.
  int error(Value8 a, Value8 b) const {
    int sum = 0;
    for (int c = 0; c < 3; ++c) {
      const int d = int{a[c]} - int{b[c]};
      sum += weights[static_cast<std::size_t>(c)] * d * d;
    }
    return sum;
  }
  /// Returns the price in bits of an error() of 1. It stays finite if the bound is 0.
  constexpr float price() const { return kBoundPrice / (static_cast<float>(bound) + 1e-3f); }
  /// Returns the weighted mean of the channels, times the sum of the weights.
  constexpr int grey(Value8 value) const {
    return weights[0] * value.x + weights[1] * value.y + weights[2] * value.z;
  }
};

/// Makes a metric whose largest error is `bound`, 0 to 255.
ValueMetric make_value_metric(std::array<int, 3> weights, double bound);

/// Returns the coarsest precision whose rounding of ends costs little, and with which an end can
/// stand for every value within the bound.
PagePrecision choose_precision(const ValueMetric& metric);

}  // namespace voxdag
