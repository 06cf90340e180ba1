#pragma once
/// Samples points on lights: the direction of a shadow ray, and the light that arrives along it.
///
/// Discs and rectangles are sampled by area, spheres by the solid angle that they subtend
/// (P. Shirley, C. Wang and K. Zimmerman, "Monte Carlo Techniques for Direct Lighting
/// Calculations", 1996), the sun's disc by its projection.
#include <cmath>
#include <numbers>

#include "voxdag/render/basis.hpp"
#include "voxdag/render/render_setup.hpp"
#include "voxdag/render/surface_point.hpp"

namespace voxdag {

struct LightSample {
  /// The direction from the start of the rays: a lamp is at start + direction, the sun infinitely
  /// far along it.
  Vec3f direction;
  /// The irradiance of the surface per unit of the light's colour; 0 if no light can arrive.
  float weight = 0;
};

/// Returns sample `i` of a pixel, seen from the point's surface. The mean of the weights over all
/// samples is the unoccluded irradiance.
VOXDAG_HD inline LightSample sample_light(const SampleTables& tables, const Light& light,
                                          const SurfacePoint& point, const PixelSamples& pixel,
                                          int i) {
  const Vec3f to_light = light.position - point.surface.position;
  const int at = pixel.set * tables.light_count + i;
  LightSample sample;
  float emitted = 1;  // multiplied below by cosine / distance²
  switch (light.kind) {
    case LightKind::kSun: {
      const Point2f p = pixel.rotated(tables.disc[at]);
      sample.direction = light.position + light.u * p.x + light.v * p.y;
      emitted = dot(sample.direction, sample.direction);
      break;
    }
    case LightKind::kPoint:
      sample.direction = to_light;
      break;
    case LightKind::kDisc: {
      const Point2f p = pixel.rotated(tables.disc[at]);
      sample.direction = to_light + light.u * p.x + light.v * p.y;
      break;
    }
    case LightKind::kRectangle: {
      const Point2f p = pixel.shifted(tables.square[at]);
      sample.direction = to_light + light.u * p.x + light.v * p.y;
      break;
    }
    case LightKind::kSphere: {
      const float distance2 = dot(to_light, to_light), radius2 = light.radius * light.radius;
      if (!(distance2 > radius2)) return sample;
      const float distance = std::sqrt(distance2);
      const float sin2 = radius2 / distance2;
      // 1 - cos of the cone's angle, without cancellation for small angles.
      const float cap = sin2 / (1 + std::sqrt(1 - sin2));
      const Point2f p = pixel.rotated(tables.disc[at]);
      const float p2 = p.x * p.x + p.y * p.y;
      const float rise = p2 * cap;  // 1 - cos of the sample's angle
      const float spread2 = rise * (2 - rise);
      const Vec3f axis = to_light * (1 / distance);
      const Basis<float> basis = make_basis(axis);
      const float scale = std::sqrt(spread2 / p2);
      const Vec3f unit = basis.u * (p.x * scale) + basis.v * (p.y * scale) + axis * (1 - rise);
      const float depth2 = radius2 - distance2 * spread2;
      const float front = distance * (1 - rise) - std::sqrt(depth2 > 0 ? depth2 : 0.0f);
      sample.direction = unit * front;
      emitted = 2 * std::numbers::pi_v<float> * cap * front * front;
      break;
    }
  }
  const float distance2 = dot(sample.direction, sample.direction);
  if (!(distance2 > 0)) return sample;
  if (light.kind == LightKind::kDisc || light.kind == LightKind::kRectangle) {
    const float facing = -dot(light.normal, sample.direction);
    emitted = facing > 0 ? light.area * facing / std::sqrt(distance2) : 0.0f;
  }
  const auto is_above = [&] {
    return dot(point.normal, sample.direction) > 0 && dot(point.face, sample.direction) > 0;
  };
  if (!is_above()) return sample;
  const float above = dot(point.normal, sample.direction);
  if (light.kind != LightKind::kSun) {
    // Rays start a little above the surface. A very near light may lie below their start.
    sample.direction = sample.direction + (point.surface.position - point.start.position);
    if (!is_above()) return sample;
  }
  sample.weight = emitted * above / (distance2 * std::sqrt(distance2));
  return sample;
}

/// Returns the direction from the point's surface to the place on the light that `sample` chose.
VOXDAG_HD inline Vec3f direction_from_surface(const Light& light, const SurfacePoint& point,
                                              const LightSample& sample) {
  if (light.kind == LightKind::kSun) return sample.direction;
  return sample.direction + (point.start.position - point.surface.position);
}

}  // namespace voxdag
