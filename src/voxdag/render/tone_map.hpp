#pragma once
/// Tone mapping: maps the light of a scene to the range of a display.
#include "voxdag/core/vec.hpp"

namespace voxdag {

/// Maps linear light to linear light in [0,1] by a filmic curve. Source: K. Narkowicz, "ACES Filmic
/// Tone Mapping Curve", 2016.
VOXDAG_HD inline float tone_map(float x) {
  const float y = (x * (2.51f * x + 0.03f)) / (x * (2.43f * x + 0.59f) + 0.14f);
  return y < 0 ? 0.0f : y > 1 ? 1.0f : y;
}

VOXDAG_HD inline Vec3f tone_map(Vec3f rgb) {
  return {tone_map(rgb.x), tone_map(rgb.y), tone_map(rgb.z)};
}

}  // namespace voxdag
