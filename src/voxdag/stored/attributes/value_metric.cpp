#include "voxdag/stored/attributes/value_metric.hpp"

#include <cmath>

namespace voxdag {

ValueMetric make_value_metric(std::array<int, 3> weights, double bound) {
  ValueMetric metric;
  metric.weights = weights;
  metric.bound = static_cast<int>(std::floor(bound * bound * metric.sum() + 1e-9));
  return metric;
}

PagePrecision choose_precision(const ValueMetric& metric) {
  for (int code = 0; code < 3; ++code) {
    int worst = 0;
    float mean = 0;  // of the squared errors, as if rounding were random
    for (int c = 0; c < 3; ++c) {
      // The values of neighbouring ends differ by at most this step.
      const int step = (1 << (8 - PagePrecision{code}.channel_bits(c))) + 1;
      const int weight = metric.weights[static_cast<std::size_t>(c)];
      worst += weight * (step / 2) * (step / 2);
      mean += static_cast<float>(weight * (step - 1) * (step - 1)) / 12;
    }
    // Rounding costs a block this much for each of its values; a finer end costs bits once.
    constexpr float kMaxBits = 0.13f;
    if (worst <= metric.bound && mean * metric.price() <= kMaxBits) return {code};
  }
  return {3};
}

}  // namespace voxdag
