#pragma once
#include <algorithm>
#include <cmath>

#include "voxdag/core/grid.hpp"

namespace voxdag {

/// Returns the voxel of the grid, which need not lie in it, that contains a point in world units.
/// Coordinates are clamped to 32 bits; NaN becomes the least one.
inline Vec3i containing_voxel(const Grid& grid, Vec3d world) {
  const Vec3d point = (world - grid.origin) * (1 / grid.voxel_size);
  Vec3i voxel;
  for (int axis = 0; axis < 3; ++axis) {
    constexpr double kMax = 2147483647;
    const double at = std::floor(point[axis]);
    voxel[axis] = static_cast<std::int32_t>(at >= -kMax ? std::min(at, kMax) : -kMax);
  }
  return voxel;
}

}  // namespace voxdag
