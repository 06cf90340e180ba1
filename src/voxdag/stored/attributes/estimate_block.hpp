#pragma once
/// Estimates what a block of values costs, its bits and the price of its errors, from sums over the
/// values.
#include <algorithm>
#include <array>
#include <cstdint>

#include "voxdag/stored/attributes/value_metric.hpp"

namespace voxdag {

/// Sums over a run of values, and the extents of some functions of them. Adding the sums of two
/// runs gives the sums of both.
struct ValueSums {
  std::int32_t count = 0;
  std::array<std::int32_t, 3> sum{};
  /// Products of channels: 00, 11, 22, 01, 02, 12.
  std::array<std::int32_t, 6> products{};
  /// Extents of the channels, of the differences 0 - 1 and 2 - 1 of channels, and of grey().
  std::array<std::int16_t, 6> lo{}, hi{};
  /// The first value, and the first value that differs from it, if there is one.
  Value8 first{}, other{};
  int distinct = 0;  ///< Number of different values; 3 stands for more than 2.

  static ValueSums of(Value8 value, const ValueMetric& metric) {
    const std::int32_t x = value.x, y = value.y, z = value.z;
    ValueSums sums;
    sums.count = 1;
    sums.first = value;
    sums.distinct = 1;
    sums.sum = {x, y, z};
    sums.products = {x * x, y * y, z * z, x * y, x * z, y * z};
    const int extents[] = {x, y, z, x - y, z - y, metric.grey(value)};
    for (std::size_t i = 0; i < 6; ++i)
      sums.lo[i] = sums.hi[i] = static_cast<std::int16_t>(extents[i]);
    return sums;
  }

  ValueSums& operator+=(const ValueSums& more) {
    count += more.count;
    include(more.first, more.distinct);
    if (more.distinct > 1) include(more.other, more.distinct);
    for (std::size_t i = 0; i < 3; ++i) sum[i] += more.sum[i];
    for (std::size_t i = 0; i < 6; ++i) products[i] += more.products[i];
    for (std::size_t i = 0; i < 6; ++i) {
      lo[i] = std::min(lo[i], more.lo[i]);
      hi[i] = std::max(hi[i], more.hi[i]);
    }
    return *this;
  }
  friend ValueSums operator+(ValueSums a, const ValueSums& b) { return a += b; }

  float mean(std::size_t channel) const {
    return static_cast<float>(sum[channel]) / static_cast<float>(count);
  }
  /// Returns the sum of the products of two channels' differences from their means. `product` is
  /// the index in `products`.
  float spread(std::size_t product, std::size_t a, std::size_t b) const {
    const std::int64_t exact =
        std::int64_t{products[product]} * count - std::int64_t{sum[a]} * sum[b];
    return static_cast<float>(exact) / static_cast<float>(count);
  }

 private:
  /// Counts a value that is one of `all` different values.
  void include(Value8 value, int all) {
    if (all > 2) distinct = 3;
    if (distinct > 2 || value == first || (distinct == 2 && value == other)) return;
    if (distinct == 1) other = value;
    ++distinct;
  }
};

/// Returns the sum of the errors between the values and their mean.
inline float total_spread(const ValueSums& sums, const ValueMetric& metric) {
  float total = 0;
  for (std::size_t c = 0; c < 3; ++c)
    total += static_cast<float>(metric.weights[c]) * sums.spread(c, c, c);
  return total;
}

/// Returns the part of total_spread() that lies along grey. The rest is the sum of the errors
/// between the values and the line along grey through their mean.
inline float grey_spread(const ValueSums& sums, const ValueMetric& metric) {
  const auto w = [&](std::size_t c) { return static_cast<float>(metric.weights[c]); };
  const float squares = w(0) * w(0) * sums.spread(0, 0, 0) + w(1) * w(1) * sums.spread(1, 1, 1) +
                        w(2) * w(2) * sums.spread(2, 2, 2);
  const float products = w(0) * w(1) * sums.spread(3, 0, 1) + w(0) * w(2) * sums.spread(4, 0, 2) +
                         w(1) * w(2) * sums.spread(5, 1, 2);
  return (squares + 2 * products) / static_cast<float>(metric.sum());
}

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
  BlockEstimator(const Value8* values, const ValueMetric& metric, PagePrecision precision);

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
    return static_cast<float>(precision_.bits_of({type, sums.count}));
  }

  const Value8* values_;
  const ValueMetric& metric_;
  PagePrecision precision_;
  float price_;
  float rounding_ = 0;  // mean error of an end
};

}  // namespace voxdag
