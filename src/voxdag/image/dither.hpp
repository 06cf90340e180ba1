#pragma once
/// Rounds to 8-bit codes by dithering, which keeps gradients smooth.
#include <cmath>
#include <cstdint>

namespace voxdag {

/// Returns the rounding threshold of pixel (x, y), in [0,1): a fraction between two codes is
/// rounded up if it is at least that. Thresholds of neighbouring pixels are spread evenly.
///
/// Source: J. Jimenez, "Next Generation Post Processing in Call of Duty: Advanced Warfare",
/// SIGGRAPH 2014 courses: interleaved gradient noise.
inline float dither_threshold(int x, int y) {
  const auto fraction = [](double value) { return value - std::floor(value); };
  return static_cast<float>(fraction(52.9829189 * fraction(0.06711056 * x + 0.00583715 * y)));
}

/// Rounds a value in [0,1] at pixel (x, y) down or up to a code, so that the mean over neighbouring
/// pixels is the value. 0 and 1 are exact; values outside are clamped, NaN becomes 0.
inline std::uint8_t dithered_code(float value, int x, int y) {
  if (!(value > 0)) return 0;
  if (value >= 1) return 255;
  return static_cast<std::uint8_t>(value * 255 + dither_threshold(x, y));
}

}  // namespace voxdag
