#pragma once
/// Estimates what a block of values costs: its bits, and the price of its errors.
#include <cstdint>

#include "voxdag/stored/attributes/value_sums.hpp"

namespace voxdag {

/// The line through values along which they vary most. The channels are scaled by the roots of
/// their weights.
struct PrincipalAxis {
  float direction[3] = {};  ///< Unit length; zero if all values are equal.
  float spread = 0;         ///< Sum of the squared distances from the mean along the axis.
};
/// Returns the axis of the values with these sums, by a few steps of the power method.
PrincipalAxis principal_axis(const ValueSums& sums, const ValueMetric& metric);

/// The extent of values around a line through their mean.
struct AxisExtent {
  float lo = 0, hi = 0;    ///< The smallest and the largest distance from the mean, with sign.
  float farthest_off = 0;  ///< The largest squared distance from the axis.
};
/// Returns the extent of the values with these sums.
AxisExtent extent_along(const PrincipalAxis& axis, const Value8* values, const ValueSums& sums,
                        const ValueMetric& metric);

/// Estimates blocks in constant time, except blocks whose values are far from a line along grey:
/// their time is linear.
class BlockEstimator {
 public:
  /// Refers to the values and the metric.
  BlockEstimator(const Value8* values, const ValueMetric& metric, EndPrecision precision);

  /// Returns the estimated cost in bits of the values from `begin` on, whose sums are `sums`, as
  /// one block of the best type that is expected to keep the bound.
  float cost(int begin, const ValueSums& sums) const;

 private:
  float two_value_cost(const ValueSums& sums, float rounding) const;
  float principal_cost(int begin, const ValueSums& sums, float total, float least) const;
  float line_error(int weight_bits, float spread, float range2) const;
  float lines_cost(const ValueSums& sums, bool is_grey, float fixed, float farthest_off,
                   float spread, float extent2, float least) const;
  float bits(int type, const ValueSums& sums) const {
    return static_cast<float>(ValueBlock{type, sums.count}.bits(end_bits_));
  }

  const Value8* values_;
  const ValueMetric& metric_;
  int end_bits_;
  float price_;
  float rounding_ = 0;  // mean error of an end
};

}  // namespace voxdag
