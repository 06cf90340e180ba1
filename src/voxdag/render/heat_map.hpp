#pragma once
/// A colour scale for values. Its brightness grows evenly, so that it is readable in grey too.
#include <cmath>
#include <numbers>

#include "voxdag/core/vec.hpp"

namespace voxdag {

/// Returns the display colour (sRGB, 0 to 1) for a value from 0 to 1. Source: D. A. Green, "A
/// colour scheme for the display of astronomical intensity images", 2011 ("cubehelix"), here from
/// black over blue, red and yellow to white.
inline Vec3f heat_color(float value) {
  constexpr float kStart = 0.5f, kRotations = -1.2f, kHue = 1.3f,
                  kTwoPi = 2 * std::numbers::pi_v<float>;
  const float v = value > 0 ? (value < 1 ? value : 1.0f) : 0.0f;
  const float angle = kTwoPi * (kStart / 3 + 1 + kRotations * v);
  const float spread = kHue * v * (1 - v) / 2;
  const float c = std::cos(angle) * spread, s = std::sin(angle) * spread;
  const auto clamped = [](float x) { return x < 0 ? 0.0f : x > 1 ? 1.0f : x; };
  return {clamped(v - 0.14861f * c + 1.78277f * s), clamped(v - 0.29227f * c - 0.90649f * s),
          clamped(v + 1.97294f * c)};
}

}  // namespace voxdag
