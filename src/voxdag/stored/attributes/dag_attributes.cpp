#include "voxdag/stored/attributes/dag_attributes.hpp"

#include <algorithm>
#include <numbers>

#include "voxdag/core/angles.hpp"

namespace voxdag {

ValueMetric make_normal_metric(double degrees) {
  constexpr double kUnit = 127;                          // length of a normal, in steps of 8 bits
  constexpr double kRounding = std::numbers::sqrt3 / 2;  // largest error of pack_normal()
  // A vector this far from a normal of length kUnit is within the angle, even if it is shorter.
  const double distance =
      kUnit * sine_and_cosine(std::min(degrees, 90.0) * std::numbers::pi / 180).sine;
  return make_value_metric({1, 1, 1}, std::max(distance - kRounding, 0.0) / std::numbers::sqrt3);
}

}  // namespace voxdag
