#pragma once
/// Makes triangles that are hard for a voxelizer.
#include <random>

#include "voxdag/builders/voxelize/grid_mapping.hpp"

namespace voxdag {

/// Returns a random triangle in a grid of 2^levels voxels. Its size is between less than a voxel
/// and the whole grid. Often it is a sliver, degenerate or axis-aligned, or has vertices on voxel
/// corners, edges or faces.
inline QuantizedTriangle random_triangle(std::mt19937_64& random, int levels) {
  const auto below = [&](std::int64_t n) {
    return static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(n));
  };
  const std::int64_t units = std::int64_t{kSubvoxels} << levels;
  const std::int64_t size = std::int64_t{1} << below(levels + 9);
  Vec3l center;
  for (int axis = 0; axis < 3; ++axis) center[axis] = below(units);
  QuantizedTriangle t;
  for (int corner = 0; corner < 3; ++corner)
    for (int axis = 0; axis < 3; ++axis) {
      std::int64_t q = center[axis] + below(size + 1) - size / 2;
      q = q < 0 ? 0 : q >= units ? units - 1 : q;
      t[corner][axis] = static_cast<std::int32_t>(q);
    }
  switch (below(8)) {
    case 0:  // on voxel corners
      for (int corner = 0; corner < 3; ++corner)
        for (int axis = 0; axis < 3; ++axis) t[corner][axis] &= ~(kSubvoxels - 1);
      break;
    case 1:  // on voxel edges or faces
      for (int corner = 0; corner < 3; ++corner) {
        t[corner][static_cast<int>(below(3))] &= ~(kSubvoxels - 1);
        t[corner][static_cast<int>(below(3))] &= ~(kSubvoxels - 1);
      }
      break;
    case 2: {  // axis-aligned, half of them on a voxel face
      const int axis = static_cast<int>(below(3));
      if (below(2) == 0) t.x[axis] &= ~(kSubvoxels - 1);
      t.y[axis] = t.z[axis] = t.x[axis];
      break;
    }
    case 3: {  // a segment
      const std::int64_t at = below(257);
      for (int axis = 0; axis < 3; ++axis)
        t.z[axis] = static_cast<std::int32_t>(
            t.x[axis] + (static_cast<std::int64_t>(t.y[axis]) - t.x[axis]) / 256 * at);
      if (below(3) == 0) t.z = t.y;
      if (below(8) == 0) t.y = t.x, t.z = t.x;
      break;
    }
    case 4:  // a sliver
      for (int axis = 0; axis < 3; ++axis) {
        const std::int64_t q = t.y[axis] + below(7) - 3;
        t.z[axis] = static_cast<std::int32_t>(q < 0 ? 0 : q >= units ? units - 1 : q);
      }
      break;
    case 5: {  // a diagonal plane through voxel corners
      for (int corner = 0; corner < 3; ++corner)
        for (int axis = 0; axis < 3; ++axis) t[corner][axis] &= ~(kSubvoxels - 1);
      for (int corner = 0; corner < 3; ++corner) t[corner].z = t[corner].x;
      break;
    }
    default:
      break;
  }
  return t;
}

}  // namespace voxdag
