#pragma once
/// Finds the interval on the way to a light in which shadow rays can meet anything.
#include "voxdag/render/light.hpp"
#include "voxdag/render/surface_point.hpp"
#include "voxdag/trace/beam.hpp"

namespace voxdag {

struct LightInterval {
  float first = 0,
        last = 0;         ///< In t of a shadow ray. A lamp is at t = 1, the sun at kSunEnd.
  bool is_clear = false;  ///< No ray meets anything.
};

/// A ray along the sun's direction has left the grid at this t.
inline constexpr float kSunEnd = 4;

/// Bounds, per axis, on the directions from a point to the points of a light.
struct DirectionBounds {
  Vec3f lowest, highest;
};

VOXDAG_HD inline DirectionBounds directions_to(const Light& light, Vec3f from) {
  if (light.kind == LightKind::kSun) return {light.lowest, light.highest};
  return {light.lowest - from, light.highest - from};
}

/// Returns whether any of these directions lies above the plane with this normal.
VOXDAG_HD inline bool reach_above(const DirectionBounds& bounds, Vec3f normal) {
  const Vec3f a = bounds.lowest * normal, b = bounds.highest * normal;
  const Vec3f most = max(a, b);
  return most.x + most.y + most.z > 0;
}

VOXDAG_HD inline LightInterval light_interval(const Light& light) {
  return {0, light.kind == LightKind::kSun ? kSunEnd : 1.0f, false};
}

/// Finds the interval with two beams: from the point to the light, and back.
template <class Nodes>
VOXDAG_HD inline LightInterval cast_light_beam(const Nodes& nodes, const Light& light,
                                               const SurfacePoint& point) {
  LightInterval interval = light_interval(light);
  const DirectionBounds bounds = directions_to(light, point.start.position);
  Beam beam;
  beam.apex = static_cast<Vec3d>(point.start.position) - Vec3d{1, 1, 1};
  beam.lowest = static_cast<Vec3d>(bounds.lowest);
  beam.highest = static_cast<Vec3d>(bounds.highest);
  beam.t_max = static_cast<double>(interval.last);
  const Vec3d width = beam.highest - beam.lowest;
  BeamStop stop;
  stop.at_start = static_cast<double>(point.cell_side);
  stop.per_enter = max(max(Vec3d{width.x}, Vec3d{width.y}), Vec3d{width.z}).x;
  double first, last;
  if (!first_met(nodes, beam, stop, first)) {
    interval.is_clear = true;
    return interval;
  }
  beam.t_min = first;
  constexpr double kRounding = 1e-6;  // rounds to float outwards
  interval.first = static_cast<float>(first * (1 - kRounding));
  if (last_met(nodes, beam, stop, last)) {
    const auto rounded = static_cast<float>(last * (1 + kRounding));
    interval.last = rounded < interval.last ? rounded : interval.last;  // never behind the light
  }
  return interval;
}

}  // namespace voxdag
