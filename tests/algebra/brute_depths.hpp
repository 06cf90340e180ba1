#pragma once
/// The depths of voxels, by looking at all empty places.
#include <algorithm>
#include <cstdint>
#include <limits>

#include "algebra/voxel_grid.hpp"

namespace voxdag {

/// Returns four times the squared distance from the centre of a voxel to the nearest cube of an
/// empty place. Places around the grid are empty.
inline std::int64_t brute_depth_square(const VoxelGrid& grid, Vec3i voxel) {
  const std::int32_t side = 1 << grid.levels();
  std::int64_t least = std::numeric_limits<std::int64_t>::max();
  for (std::int32_t z = -1; z <= side; ++z)
    for (std::int32_t y = -1; y <= side; ++y)
      for (std::int32_t x = -1; x <= side; ++x) {
        const Vec3i place{x, y, z};
        if (grid.contains(place)) continue;
        std::int64_t sum = 0;
        for (int axis = 0; axis < 3; ++axis) {
          const std::int64_t steps = std::abs(place[axis] - voxel[axis]);
          if (steps != 0) sum += (2 * steps - 1) * (2 * steps - 1);
        }
        least = std::min(least, sum);
      }
  return least;
}

}  // namespace voxdag
