#pragma once
/// Tone mapping: maps the light of a scene to the range of a display.
#include "voxdag/core/vec.hpp"

namespace voxdag {

/// The curve (a x² + b x) / (c x² + d x + e).
struct ToneCurve {
  static constexpr float kA = 2.51f, kB = 0.03f, kC = 2.43f, kD = 0.59f, kE = 0.14f;
};

/// Maps linear light to linear light in [0,1] by a filmic curve. Source: K. Narkowicz, "ACES Filmic
/// Tone Mapping Curve", 2016.
VOXDAG_HD inline float tone_map(float x) {
  const float y = (x * (ToneCurve::kA * x + ToneCurve::kB)) /
                  (x * (ToneCurve::kC * x + ToneCurve::kD) + ToneCurve::kE);
  return y < 0 ? 0.0f : y > 1 ? 1.0f : y;
}

VOXDAG_HD inline Vec3f tone_map(Vec3f rgb) {
  return {tone_map(rgb.x), tone_map(rgb.y), tone_map(rgb.z)};
}

}  // namespace voxdag
