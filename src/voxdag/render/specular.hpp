#pragma once
/// Phong highlights: the mirror images of lights, blurred.
///
/// Source: B. T. Phong, "Illumination for Computer Generated Pictures", CACM 1975, normalised as in
/// E. Lafortune and Y. Willems, "Using the Modified Phong Reflectance Model for Physically Based
/// Rendering", 1994. The brightness of a highlight falls with a power of the cosine of the angle
/// between the light and the mirrored line of sight.
#include <numbers>

#include "voxdag/core/host_device.hpp"
#include "voxdag/core/vec.hpp"

namespace voxdag {

/// The highlights of all surfaces. They have the colour of the light, and add to the diffuse light:
/// the sum conserves energy if albedo and strength add up to 1 or less.
struct Specular {
  /// The part of the light from straight above that is mirrored, 0 to 1; other directions lose some
  /// of the lobe below the surface. 0: no highlights.
  float strength = 0;
  int exponent = 20;  ///< 1 to 10,000: the larger, the smaller and brighter the highlights.

  VOXDAG_HD constexpr bool is_on() const { return strength > 0; }
};

/// Returns x to the power of n >= 0. It only multiplies, so that every device gets the same bits.
VOXDAG_HD constexpr float whole_power(float x, int n) {
  float result = 1;
  for (; n > 0; n /= 2, x *= x)
    if (n % 2 != 0) result *= x;
  return result;
}

/// Returns the direction to the viewer, mirrored at the normal; both have unit length.
VOXDAG_HD constexpr Vec3f mirrored_view(Vec3f to_viewer, Vec3f normal) {
  return normal * (2 * dot(normal, to_viewer)) - to_viewer;
}

/// Returns the radiance towards the viewer per irradiance from a light. `mirrored` is
/// mirrored_view(), `to_light` the direction to the light; both have unit length.
VOXDAG_HD constexpr float phong_lobe(const Specular& specular, Vec3f mirrored, Vec3f to_light) {
  const float cosine = dot(mirrored, to_light);
  if (!(cosine > 0)) return 0;
  const float scale =
      static_cast<float>(specular.exponent + 2) * (0.5f / std::numbers::pi_v<float>);
  return specular.strength * scale * whole_power(cosine, specular.exponent);
}

}  // namespace voxdag
