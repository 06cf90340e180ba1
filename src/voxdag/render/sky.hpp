#pragma once
/// The light of a picture: a sun and a clear sky, or a map of all directions, in arbitrary linear
/// units.
#include <cmath>

#include "voxdag/render/camera.hpp"

namespace voxdag {

/// Light from all directions instead of the clear sky: see environment.hpp. Owns nothing.
struct SkyMap {
  const Vec3f* texels = nullptr;  ///< side² octahedral texels, row by row; null: the clear sky.
  int side = 0;
  Vec3f right{1, 0, 0}, up{0, 1, 0}, back{0, 0, 1};  ///< The map's axes x, y, z in the world.
  /// Irradiance, divided by pi, of a surface with the normal n in the map's axes: the sum over the
  /// basis 1, x, y, z, xy, yz, zx, x² - y², 3 z² - 1 of n.
  Vec3f harmonics[9]{};
  float scale = 1;  ///< Factor on both.
};

struct Sky {
  Vec3f up{0, 1, 0};                   ///< Unit length.
  Vec3f sun{0, 1, 0};                  ///< Unit length, towards the sun.
  Vec3f fill{1, 0, 0};                 ///< Unit length, towards the soft fill light.
  Vec3f sun_light{2.9f, 2.65f, 2.3f};  ///< Irradiance / pi on a surface that faces the sun.
  Vec3f zenith{0.32f, 0.52f, 0.95f};
  Vec3f horizon{0.86f, 0.92f, 1.0f};
  Vec3f ground{0.43f, 0.41f, 0.39f};  ///< Radiance of the ground, below the horizon.
  SkyMap map;                         ///< If it has texels, replaces zenith, horizon and ground.
};

/// The numbers of sky_radiance(), sky_ambient() and sky_part().
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

/// Returns the place of a direction in an octahedral map of [-1,1]². y is up, and in the middle.
VOXDAG_HD inline void octahedral_place(Vec3f direction, float& x, float& y) {
  const float sum = std::fabs(direction.x) + std::fabs(direction.y) + std::fabs(direction.z);
  x = direction.x / sum;
  y = direction.z / sum;
  if (direction.y >= 0) return;
  const float folded_x = 1 - std::fabs(y), folded_y = 1 - std::fabs(x);
  x = x < 0 ? -folded_x : folded_x;
  y = y < 0 ? -folded_y : folded_y;
}

/// Returns the texel (x,y) of an octahedral map, -1 <= x, y <= side. Beyond an edge the map goes on
/// at the mirrored place of the same edge.
VOXDAG_HD inline Vec3f octahedral_texel(const SkyMap& map, int x, int y) {
  const int last = map.side - 1;
  if (x < 0 || x > last) {
    x = x < 0 ? 0 : last;
    y = last - y;
  }
  if (y < 0 || y > last) {
    y = y < 0 ? 0 : last;
    x = last - x;
  }
  return map.texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(map.side) +
                    static_cast<std::size_t>(x)];
}

VOXDAG_HD inline Vec3f in_map(const SkyMap& map, Vec3f direction) {
  return {dot(direction, map.right), dot(direction, map.up), dot(direction, map.back)};
}

/// Returns the map's radiance from a direction of the world, bilinearly.
VOXDAG_HD inline Vec3f map_radiance(const SkyMap& map, Vec3f direction) {
  float x, y;
  octahedral_place(in_map(map, direction), x, y);
  const float half = static_cast<float>(map.side) * 0.5f;
  x = (x + 1) * half - 0.5f;
  y = (y + 1) * half - 0.5f;
  const float left = std::floor(x), top = std::floor(y);
  const int column = static_cast<int>(left), row = static_cast<int>(top);
  const Vec3f above =
      mix(octahedral_texel(map, column, row), octahedral_texel(map, column + 1, row), x - left);
  const Vec3f below = mix(octahedral_texel(map, column, row + 1),
                          octahedral_texel(map, column + 1, row + 1), x - left);
  return mix(above, below, y - top) * map.scale;
}

/// Returns the map's irradiance, divided by pi, on an unoccluded surface.
VOXDAG_HD inline Vec3f map_ambient(const SkyMap& map, Vec3f normal) {
  const Vec3f n = in_map(map, normal);
  const Vec3f* const h = map.harmonics;
  Vec3f light = h[0] + h[1] * n.x + h[2] * n.y + h[3] * n.z + h[4] * (n.x * n.y) +
                h[5] * (n.y * n.z) + h[6] * (n.z * n.x) + h[7] * (n.x * n.x - n.y * n.y) +
                h[8] * (3 * n.z * n.z - 1);
  for (int c = 0; c < 3; ++c) light[c] = light[c] > 0 ? light[c] * map.scale : 0.0f;
  return light;
}

/// Returns the radiance along a ray that leaves the scene. `direction` has unit length.
VOXDAG_HD inline Vec3f sky_radiance(const Sky& sky, Vec3f direction) {
  if (sky.map.texels != nullptr) return map_radiance(sky.map, direction);
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
  if (sky.map.texels != nullptr) return map_ambient(sky.map, normal);
  const float height = dot(normal, sky.up);
  const Vec3f dome = mix(sky.zenith, sky.horizon, SkyShape::kHorizonInDome);
  return mix(sky.ground, dome, 0.5f + 0.5f * height);
}

}  // namespace voxdag
