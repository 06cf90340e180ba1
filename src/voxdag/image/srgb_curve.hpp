#pragma once
/// Linear light to sRGB by table, for many values.
#include <array>
#include <cmath>
#include <cstddef>

#include "voxdag/image/color.hpp"

namespace voxdag {

/// Encoded value in [0,1] of linear light, which is clamped to [0,1]; monotone, within 1e-5 of
/// linear_to_srgb.
inline float linear_to_srgb_fast(float linear) {
  constexpr std::size_t kSteps = 1024;
  // Over the square root the curve is nearly straight.
  static const std::array<float, kSteps + 2> table = [] {
    std::array<float, kSteps + 2> values{};
    for (std::size_t i = 0; i <= kSteps; ++i) {
      const float root = static_cast<float>(i) / kSteps;
      values[i] = linear_to_srgb(root * root);
    }
    values[kSteps + 1] = values[kSteps];
    return values;
  }();
  if (!(linear > 0)) return 0;
  if (linear >= 1) return 1;
  const float place = std::sqrt(linear) * kSteps;
  const auto i = static_cast<std::size_t>(place);
  return table[i] + (table[i + 1] - table[i]) * (place - static_cast<float>(i));
}

}  // namespace voxdag
