#pragma once
/// The sRGB transfer function (IEC 61966-2-1) and its inverse, in the exact piecewise form.
#include <cmath>

#include "voxdag/core/host_device.hpp"

namespace voxdag {

/// Converts an encoded value in [0,1] to linear light in [0,1].
VOXDAG_HD inline float srgb_to_linear(float encoded) {
  return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

/// Converts linear light in [0,1] to the encoded value in [0,1].
VOXDAG_HD inline float linear_to_srgb(float linear) {
  return linear <= 0.0031308f ? linear * 12.92f : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

}  // namespace voxdag
