#pragma once
/// A ray: a segment of a line, in world units.
#include "voxdag/core/vec.hpp"

namespace voxdag {

/// The points origin + t * direction for t_min <= t <= t_max. The direction need not have unit
/// length; t is in units of its length. t_min may be negative or -infinity, t_max may be +infinity.
/// A ray with a NaN, an infinite origin or direction, a direction of zero length, or t_min > t_max
/// meets nothing. The layout is that of one row of a rays.npy (8 float32).
struct Ray {
  Vec3f origin;
  float t_min = 0;
  Vec3f direction;
  float t_max = 0;
};
static_assert(sizeof(Ray) == 32);

}  // namespace voxdag
