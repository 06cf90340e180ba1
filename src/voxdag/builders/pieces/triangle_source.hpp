#pragma once
/// The triangles that an octree is built from.
#include <cmath>
#include <cstdint>
#include <vector>

#include "voxdag/builders/voxelize/grid_mapping.hpp"
#include "voxdag/core/box.hpp"
#include "voxdag/core/grid.hpp"
#include "voxdag/core/parallel/find_duplicates.hpp"
#include "voxdag/mesh/displace/displaced_triangles.hpp"

namespace voxdag {

/// Returns the longest edge that tessellation leaves, in world units before displacement. Edges are
/// about a voxel long: from half of this length to all of it.
inline double displaced_edge_limit(const Grid& grid) { return std::sqrt(2.0) * grid.voxel_size; }

struct TriangleSource {
  const Grid& grid;
  const QuantizedMesh& mesh;
  const std::vector<std::uint8_t>& open_edges;  ///< Per triangle of the quantised mesh.
  const DisplacedTriangles* displaced;          ///< Null if nothing is displaced.
  /// Triangles of the mesh that are not built, because they repeat others.
  const IndexSet& duplicates;

  /// Returns whether a triangle of the quantised mesh is a duplicate.
  bool is_duplicate(std::size_t triangle) const {
    return duplicates.contains(mesh.source(triangle));
  }

  bool is_displaced(std::uint32_t triangle) const {
    return displaced != nullptr && triangle < mesh.mesh_triangle_count() &&
           displaced->is_displaced(triangle);
  }

  double edge_limit() const { return displaced_edge_limit(grid); }
};

/// Returns the box of a cell of 2^log2_size voxels in world units, with a margin for rounding.
/// `cell` is in cells of that size.
inline Box3d world_box(const Grid& grid, Vec3i cell, int log2_size) {
  const double size = static_cast<double>(std::int64_t{1} << log2_size), margin = 1.0 / kSubvoxels;
  const Vec3d lo = static_cast<Vec3d>(cell) * size;
  return {grid.to_world(lo - Vec3d{margin, margin, margin}),
          grid.to_world(lo + Vec3d{size + margin, size + margin, size + margin})};
}

}  // namespace voxdag
