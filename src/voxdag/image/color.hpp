#pragma once
/// Converts linear light to the 8-bit sRGB codes of image files, and to sRGB by a fast table.
/// core/srgb.hpp has the exact curves.
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "voxdag/core/srgb.hpp"

namespace voxdag {

/// Converts linear light to the nearest 8-bit sRGB code. Values outside [0,1] are clamped, NaN
/// becomes 0.
VOXDAG_HD inline std::uint8_t linear_to_srgb8(float linear) {
  if (!(linear > 0.0f)) return 0;
  if (linear >= 1.0f) return 255;
  return static_cast<std::uint8_t>(linear_to_srgb(linear) * 255.0f + 0.5f);
}

VOXDAG_HD inline float srgb8_to_linear(std::uint8_t code) {
  return srgb_to_linear(static_cast<float>(code) / 255.0f);
}

/// Computes linear_to_srgb by table: monotone, within 1e-5 of the curve. Values outside [0,1] are
/// clamped, NaN becomes 0.
inline float linear_to_srgb_fast(float linear) {
  constexpr std::size_t kSteps = 1024;
  // As a function of the square root, the curve is nearly linear.
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
