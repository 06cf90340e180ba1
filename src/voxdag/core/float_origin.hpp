#pragma once
/// The place from which points are measured before they are rounded to float32.
#include <algorithm>
#include <cmath>

#include "voxdag/core/box.hpp"

namespace voxdag {

/// A box is far from 0 along an axis if it is farther away than this times its longest side.
inline constexpr double kFarSides = 16;

/// Returns the origin from which points in `box` are measured, in double, before they are rounded
/// to float32. Along an axis along which the box is far from 0, it is the box's lower bound; along
/// others it is 0, so that points near 0 keep their nearest float32. Returns 0 for an empty box.
inline Vec3d float_origin(const Box3d& box) {
  Vec3d origin{};
  if (box.is_empty()) return origin;
  const Vec3d side = box.hi - box.lo;
  const double longest = std::max({side.x, side.y, side.z});
  for (int axis = 0; axis < 3; ++axis)
    if (std::max(box.lo[axis], -box.hi[axis]) > kFarSides * longest) origin[axis] = box.lo[axis];
  return origin;
}

/// Returns the largest error of a coordinate of points in `box` that are measured from `origin`
/// and rounded to float32. 0 for an empty box.
inline double float_rounding(const Box3d& box, Vec3d origin) {
  double farthest = 0;
  if (box.is_empty()) return farthest;
  for (const Vec3d corner : {box.lo - origin, box.hi - origin})
    for (int axis = 0; axis < 3; ++axis) farthest = std::max(farthest, std::abs(corner[axis]));
  return farthest * 0x1p-24;
}

}  // namespace voxdag
