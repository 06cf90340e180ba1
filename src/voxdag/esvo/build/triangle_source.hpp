#pragma once
/// Where the triangles of an ESVO in the making come from.
#include <cmath>
#include <cstdint>
#include <vector>

#include "voxdag/core/box.hpp"
#include "voxdag/core/grid.hpp"
#include "voxdag/displace/displaced_triangles.hpp"
#include "voxdag/voxelize/grid_mapping.hpp"

namespace voxdag {

/// The longest edge, before displacement, that a displaced triangle is left with: edges end up
/// between half of it and all of it, a voxel long.
inline double displaced_edge_limit(const Grid& grid) { return std::sqrt(2.0) * grid.voxel_size; }

struct TriangleSource {
  const Grid& grid;
  const QuantizedMesh& mesh;
  const std::vector<std::uint8_t>& open_edges;  ///< By triangle of the quantised mesh.
  const DisplacedTriangles* displaced;          ///< Null where nothing is.

  bool is_displaced(std::uint32_t triangle) const {
    return displaced != nullptr && triangle < mesh.mesh_triangle_count() &&
           displaced->is_displaced(triangle);
  }

  double edge_limit() const { return displaced_edge_limit(grid); }
};

/// A cell of 2^log2_size voxels, in world units, with a little more around for rounding. `cell`
/// counts cells of its size.
inline Box3d world_box(const Grid& grid, Vec3i cell, int log2_size) {
  const double size = static_cast<double>(std::int64_t{1} << log2_size), margin = 1.0 / kSubvoxels;
  const Vec3d lo = static_cast<Vec3d>(cell) * size;
  return {grid.to_world(lo - Vec3d{margin, margin, margin}),
          grid.to_world(lo + Vec3d{size + margin, size + margin, size + margin})};
}

}  // namespace voxdag
