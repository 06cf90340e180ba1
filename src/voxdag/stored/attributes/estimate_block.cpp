#include "voxdag/stored/attributes/estimate_block.hpp"

#include <cmath>

namespace voxdag {
namespace {

/// The mean squared error of normally distributed values of variance 1 that are rounded to 2^w
/// values at equal distances; w = 0 to 4.
constexpr float kNormalError[] = {1, 0.363f, 0.119f, 0.0374f, 0.0115f};

constexpr float square(float v) { return v * v; }

}  // namespace

PrincipalAxis principal_axis(const ValueSums& sums, const ValueMetric& metric) {
  float scale[3];
  for (std::size_t c = 0; c < 3; ++c) scale[c] = std::sqrt(static_cast<float>(metric.weights[c]));
  const float xx = sums.spread(0, 0, 0) * scale[0] * scale[0],
              yy = sums.spread(1, 1, 1) * scale[1] * scale[1],
              zz = sums.spread(2, 2, 2) * scale[2] * scale[2],
              xy = sums.spread(3, 0, 1) * scale[0] * scale[1],
              xz = sums.spread(4, 0, 2) * scale[0] * scale[2],
              yz = sums.spread(5, 1, 2) * scale[1] * scale[2];
  // A few steps of the power method, from the row of the largest variance.
  Vec3f axis = xx >= yy && xx >= zz ? Vec3f{xx, xy, xz}
               : yy >= zz           ? Vec3f{xy, yy, yz}
                                    : Vec3f{xz, yz, zz};
  PrincipalAxis result;
  for (int i = 0; i < 4; ++i) {
    const float length2 = dot(axis, axis);
    if (!(length2 > 0)) return result;
    axis = axis * (1 / std::sqrt(length2));
    if (i == 3) break;
    axis = {xx * axis.x + xy * axis.y + xz * axis.z, xy * axis.x + yy * axis.y + yz * axis.z,
            xz * axis.x + yz * axis.y + zz * axis.z};
  }
  for (int c = 0; c < 3; ++c) result.direction[c] = axis[c];
  result.spread = xx * axis.x * axis.x + yy * axis.y * axis.y + zz * axis.z * axis.z +
                  2 * (xy * axis.x * axis.y + xz * axis.x * axis.z + yz * axis.y * axis.z);
  return result;
}

AxisExtent extent_along(const PrincipalAxis& axis, const Value8* values, const ValueSums& sums,
                        const ValueMetric& metric) {
  float scale[3], means[3];
  for (std::size_t c = 0; c < 3; ++c) {
    scale[c] = std::sqrt(static_cast<float>(metric.weights[c]));
    means[c] = sums.mean(c);
  }
  AxisExtent extent;
  for (int i = 0; i < sums.count; ++i) {
    float along = 0, distance2 = 0;
    for (int c = 0; c < 3; ++c) {
      const float d = (static_cast<float>(values[i][c]) - means[c]) * scale[c];
      along += d * axis.direction[c];
      distance2 += d * d;
    }
    extent.lo = std::min(extent.lo, along);
    extent.hi = std::max(extent.hi, along);
    extent.farthest_off = std::max(extent.farthest_off, distance2 - along * along);
  }
  return extent;
}

BlockEstimator::BlockEstimator(const Value8* values, const ValueMetric& metric,
                               PagePrecision precision)
    : values_(values), metric_(metric), precision_(precision), price_(metric.price()) {
  for (int c = 0; c < 3; ++c) {
    const auto weight = static_cast<float>(metric.weights[static_cast<std::size_t>(c)]);
    if (precision.channel_bits(c) < 8)
      rounding_ += weight * square(static_cast<float>(1 << (8 - precision.channel_bits(c)))) / 12;
  }
}

/// Returns the expected sum of errors along a line. `spread` is the sum of the values' squared
/// distances from their mean, `range2` the square of their extent times their number.
float BlockEstimator::line_error(int weight_bits, float spread, float range2) const {
  const float even = range2 / (12 * static_cast<float>(1 << (2 * weight_bits)));
  return std::min(even, spread * kNormalError[weight_bits]);
}

/// Returns the cost of the best line in a direction, or `least` if that is less. `fixed` is the
/// price of the errors that weights cannot reduce, `farthest_off` the largest error off the line,
/// `extent2` the square of the values' extent along it.
float BlockEstimator::lines_cost(const ValueSums& sums, bool is_grey, float fixed,
                                 float farthest_off, float spread, float extent2,
                                 float least) const {
  const auto n = static_cast<float>(sums.count), bound = static_cast<float>(metric_.bound);
  for (int k = is_grey ? 1 : 2; k <= 4; ++k) {
    // Only a line of any direction has weights of 4 bits.
    const float base = bits(is_grey && k < 4 ? k : k + 3, sums) + fixed;
    if (base >= least) break;
    const auto steps = static_cast<float>((2 << k) - 2);
    if (extent2 > (bound - farthest_off) * steps * steps) continue;
    least = std::min(least, base + price_ * line_error(k, spread, n * extent2));
  }
  return least;
}

float BlockEstimator::cost(int begin, const ValueSums& sums) const {
  const auto n = static_cast<float>(sums.count), weights = static_cast<float>(metric_.sum());
  const auto bound = static_cast<float>(metric_.bound);
  const auto w = [&](std::size_t c) { return static_cast<float>(metric_.weights[c]); };
  const float total = total_spread(sums, metric_);
  const float rounding = n * rounding_;
  float least = bits(ValueBlock::kRaw, sums) + price_ * rounding;

  float farthest = 0;  // error of the corner farthest from the mean
  for (std::size_t c = 0; c < 3; ++c) {
    const float mean = sums.mean(c);
    farthest += w(c) * square(std::max(sums.hi[c] - mean, mean - sums.lo[c]));
  }
  if (farthest <= bound)
    least = std::min(least, bits(ValueBlock::kFlat, sums) + price_ * (total + rounding));
  if (sums.distinct == 2) return std::min(least, two_value_cost(sums, rounding));

  // The line along grey.
  const float grey = grey_spread(sums, metric_);
  const float off_line = std::max(total - grey, 0.0f);
  const float a = sums.mean(0) - sums.mean(1), b = sums.mean(2) - sums.mean(1);
  const auto off = [&](float da, float db) {
    return w(0) * da * da + w(2) * db * db - square(w(0) * da + w(2) * db) / weights;
  };
  // Convex: largest at a corner.
  const float lo_a = sums.lo[3] - a, hi_a = sums.hi[3] - a, lo_b = sums.lo[4] - b,
              hi_b = sums.hi[4] - b;
  const float farthest_off = std::max(std::max(off(lo_a, lo_b), off(lo_a, hi_b)),
                                      std::max(off(hi_a, lo_b), off(hi_a, hi_b)));
  const float extent = static_cast<float>(sums.hi[5] - sums.lo[5]) / weights;
  const float extent2 = weights * extent * extent;
  if (farthest_off < bound)
    least =
        lines_cost(sums, true, price_ * (off_line + rounding), farthest_off, grey, extent2, least);
  // A line along the principal axis has a longer second end, and can only reduce the errors.
  if (bits(5, sums) + price_ * rounding < least &&
      price_ * off_line > static_cast<float>(precision_.bits() - ValueBlock::kStepBits))
    return principal_cost(begin, sums, total, least);
  if (farthest_off >= bound) return principal_cost(begin, sums, total, least);
  return least;
}

/// Returns the cost of a line between the two values of a block. `rounding` is the sum of the
/// errors of its ends.
float BlockEstimator::two_value_cost(const ValueSums& sums, float rounding) const {
  const int step = sums.other.x - sums.first.x;
  const bool is_grey = sums.other.y - sums.first.y == step && sums.other.z - sums.first.z == step;
  const float exact = bits(5, sums) + price_ * rounding;
  if (!is_grey) return exact;
  constexpr float kStepError = square(ValueBlock::kStepUnit) / 12.0f;
  const auto weights = static_cast<float>(metric_.sum() * sums.count);
  return std::min(exact, bits(1, sums) + price_ * (rounding + weights * kStepError));
}

/// Returns the cost of the best line along the principal axis, or `least` if that is less.
float BlockEstimator::principal_cost(int begin, const ValueSums& sums, float total,
                                     float least) const {
  const auto n = static_cast<float>(sums.count);
  const auto bound = static_cast<float>(metric_.bound);
  const PrincipalAxis axis = principal_axis(sums, metric_);
  const float base = price_ * (std::max(total - axis.spread, 0.0f) + n * rounding_);
  if (bits(5, sums) + base >= least) return least;
  const AxisExtent extent = extent_along(axis, values_ + begin, sums, metric_);
  if (extent.farthest_off >= bound) return least;
  const float extent2 = square(extent.hi - extent.lo);
  return lines_cost(sums, false, base, extent.farthest_off, axis.spread, extent2, least);
}

}  // namespace voxdag
