#pragma once
/// Sums over consecutive values, from which the error of a block can be estimated without the
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

}  // namespace voxdag
