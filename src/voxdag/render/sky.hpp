#pragma once
/// The light of a picture: a sun and a clear sky, in arbitrary linear units.
#include <cmath>

#include "voxdag/render/camera.hpp"

namespace voxdag {

struct Sky {
  Vec3f up{0, 1, 0};                   ///< Unit length.
  Vec3f sun{0, 1, 0};                  ///< Unit length, towards the sun.
  Vec3f fill{1, 0, 0};                 ///< Unit length, towards the soft fill light.
  Vec3f sun_light{2.9f, 2.65f, 2.3f};  ///< Irradiance / pi on a surface that faces the sun.
  Vec3f zenith{0.32f, 0.52f, 0.95f};
  Vec3f horizon{0.86f, 0.92f, 1.0f};
  Vec3f ground{0.43f, 0.41f, 0.39f};  ///< What is below the horizon sends up.
};

VOXDAG_HD inline Vec3f mix(Vec3f a, Vec3f b, float t) { return a * (1 - t) + b * t; }

/// 0 below `low`, 1 above `high`, smooth between.
VOXDAG_HD inline float smooth_step(float low, float high, float x) {
  const float t = (x - low) / (high - low);
  const float s = t < 0 ? 0.0f : t > 1 ? 1.0f : t;
  return s * s * (3 - 2 * s);
}

/// What a ray sees that leaves the scene. `direction` has unit length.
VOXDAG_HD inline Vec3f sky_radiance(const Sky& sky, Vec3f direction) {
  const float height = dot(direction, sky.up);
  const float towards_sun = dot(direction, sky.sun);
  const float haze = 1 - (height > 0 ? height : 0);
  const float haze2 = haze * haze;
  Vec3f radiance = mix(sky.zenith, sky.horizon, haze2 * haze2);
  // The glow around the sun, without the disc: a picture's background, not a light.
  const float glow = towards_sun > 0 ? towards_sun * towards_sun : 0.0f;
  radiance = radiance + sky.sun_light * (0.10f * glow * glow * glow * glow);
  return mix(radiance, sky.ground * 1.3f, smooth_step(0.03f, -0.75f, height));
}

/// Irradiance divided by pi from sky and ground on a surface with this normal that nothing hides.
VOXDAG_HD inline Vec3f sky_ambient(const Sky& sky, Vec3f normal) {
  const float height = dot(normal, sky.up);
  const Vec3f dome = mix(sky.zenith, sky.horizon, 0.7f);
  return mix(sky.ground, dome, 0.5f + 0.5f * height);
}

}  // namespace voxdag
