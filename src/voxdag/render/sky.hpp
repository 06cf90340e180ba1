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
  Vec3f ground{0.43f, 0.41f, 0.39f};  ///< Radiance of the ground, below the horizon.
};

/// The numbers of sky_radiance(), sky_ambient() and sky_light().
struct SkyShape {
  static constexpr float kGlow = 0.10f;   ///< Part of the sun's light in the glow around it.
  static constexpr float kGround = 1.3f;  ///< Factor on the ground's radiance in the picture.
  /// Sky becomes ground between these sines of the angle above the horizon.
  static constexpr float kGroundBegins = 0.03f, kGroundIsFull = -0.75f;
  static constexpr float kHorizonInDome = 0.7f;  ///< Part of the horizon in the dome's mean light.
  /// Part of the sky that a surface sees where no near surface hides it: far surfaces hide the
  /// rest.
  static constexpr float kOpen = 0.7f;
  /// Light without ambient occlusion: a constant part, a part from the viewer, and a part from the
  /// viewer's right.
  static constexpr float kFill = 0.40f, kFillFacing = 0.35f, kFillAside = 0.25f;
};

inline constexpr float kInversePi = 0.318309886f;

/// Returns the luminance of a colour in linear light, with the weights of sRGB's primaries.
VOXDAG_HD inline float luminance(Vec3f color) { return dot(color, {0.2126f, 0.7152f, 0.0722f}); }

VOXDAG_HD inline Vec3f mix(Vec3f a, Vec3f b, float t) { return a * (1 - t) + b * t; }

/// Returns 0 below `low`, 1 above `high`, and a smooth curve in between.
VOXDAG_HD inline float smooth_step(float low, float high, float x) {
  const float t = (x - low) / (high - low);
  const float s = t < 0 ? 0.0f : t > 1 ? 1.0f : t;
  return s * s * (3 - 2 * s);
}

/// Returns the radiance along a ray that leaves the scene. `direction` has unit length.
VOXDAG_HD inline Vec3f sky_radiance(const Sky& sky, Vec3f direction) {
  const float height = dot(direction, sky.up);
  const float towards_sun = dot(direction, sky.sun);
  const float haze = 1 - (height > 0 ? height : 0);
  const float haze2 = haze * haze;
  Vec3f radiance = mix(sky.zenith, sky.horizon, haze2 * haze2);
  // The glow around the sun. The sun's disc is a light of its own.
  const float glow = towards_sun > 0 ? towards_sun * towards_sun : 0.0f;
  radiance = radiance + sky.sun_light * (SkyShape::kGlow * glow * glow * glow * glow);
  return mix(radiance, sky.ground * SkyShape::kGround,
             smooth_step(SkyShape::kGroundBegins, SkyShape::kGroundIsFull, height));
}

/// Returns the irradiance, divided by pi, from sky and ground on an unoccluded surface.
VOXDAG_HD inline Vec3f sky_ambient(const Sky& sky, Vec3f normal) {
  const float height = dot(normal, sky.up);
  const Vec3f dome = mix(sky.zenith, sky.horizon, SkyShape::kHorizonInDome);
  return mix(sky.ground, dome, 0.5f + 0.5f * height);
}

}  // namespace voxdag
