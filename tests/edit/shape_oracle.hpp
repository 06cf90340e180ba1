#pragma once
/// Which voxels a shape has: each voxel by itself, in integers of 128 bits.
#include "voxdag/core/int128.hpp"
#include "voxdag/edit/shapes.hpp"

namespace voxdag {

inline bool oracle_has(const EditShape& shape, Vec3i voxel) {
  Int128 center[3];
  for (int axis = 0; axis < 3; ++axis) center[axis] = Int128{voxel[axis]} * 256 + 128;
  const auto dot3 = [](const Int128(&a)[3], const Int128(&b)[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  };
  const auto minus = [](const Int128(&a)[3], Vec3l b, Int128(&result)[3]) {
    for (int axis = 0; axis < 3; ++axis) result[axis] = a[axis] - b[axis];
  };
  if (const auto* ball = std::get_if<BallShape>(&shape)) {
    Int128 d[3];
    minus(center, ball->center, d);
    return dot3(d, d) <= Int128{ball->radius} * ball->radius;
  }
  if (const auto* capsule = std::get_if<CapsuleShape>(&shape)) {
    Int128 from_a[3], from_b[3], along[3];
    minus(center, capsule->a, from_a);
    minus(center, capsule->b, from_b);
    for (int axis = 0; axis < 3; ++axis) along[axis] = capsule->b[axis] - capsule->a[axis];
    const Int128 r2 = Int128{capsule->radius} * capsule->radius;
    const Int128 t = dot3(from_a, along), length2 = dot3(along, along);
    if (dot3(from_a, from_a) <= r2 || dot3(from_b, from_b) <= r2) return true;
    return t > 0 && t < length2 && dot3(from_a, from_a) * length2 - t * t <= r2 * length2;
  }
  const auto& slabs = std::get<SlabsShape>(shape);
  for (int i = 0; i < slabs.count; ++i) {
    Int128 at = 0;
    for (int axis = 0; axis < 3; ++axis) at += slabs.slabs[i].axis[axis] * center[axis];
    if (at < slabs.slabs[i].first || at >= slabs.slabs[i].end) return false;
  }
  return true;
}

}  // namespace voxdag
