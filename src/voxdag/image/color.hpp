#pragma once
/// Colours in the 8-bit codes of image files.
#include <cstdint>

#include "voxdag/core/srgb.hpp"

namespace voxdag {

/// Linear light to the nearest 8-bit sRGB code. What lies outside [0,1] is clamped, NaN becomes 0.
VOXDAG_HD inline std::uint8_t linear_to_srgb8(float linear) {
  if (!(linear > 0.0f)) return 0;
  if (linear >= 1.0f) return 255;
  return static_cast<std::uint8_t>(linear_to_srgb(linear) * 255.0f + 0.5f);
}

VOXDAG_HD inline float srgb8_to_linear(std::uint8_t code) {
  return srgb_to_linear(static_cast<float>(code) / 255.0f);
}

}  // namespace voxdag
