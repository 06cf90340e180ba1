#pragma once
/// The boundary of a mesh: edges at which its surface ends, or changes its side.
#include <cstdint>

#include "voxdag/builders/voxelize/grid_mapping.hpp"
#include "voxdag/core/memory_budget.hpp"
#include "voxdag/core/parallel/work.hpp"

namespace voxdag {

/// An edge that the triangles run through from a to b more often than from b to a.
struct BoundaryEdge {
  Vec3i a, b;               ///< In units of 1/256 voxel.
  std::uint32_t times = 0;  ///< The difference.
};

/// Returns the boundary. Every point is the end of as many edges as begin there. A closed mesh
/// whose triangles are wound alike has none. Points are the same if they are rounded to the same
/// 1/256 voxel; triangles that the grid's range clips do not count. Takes 24 bytes per triangle in
/// `work`. Throws OverMemory and Cancelled.
CountedVector<BoundaryEdge> find_boundary_edges(const QuantizedMesh& mesh, Work work);

}  // namespace voxdag
