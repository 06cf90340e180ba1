#pragma once
/// Whether a mesh is closed.
#include <cstdint>

#include "voxdag/builders/voxelize/grid_mapping.hpp"
#include "voxdag/core/parallel/work.hpp"

namespace voxdag {

/// The edges that belong to an odd number of triangles. Points are the same if they are rounded to
/// the same 1/256 voxel.
struct OddEdges {
  std::uint64_t count = 0;
  Vec3i a, b;  ///< One of them, if there is one: in units of 1/256 voxel.
};

/// A mesh without odd edges is closed: each ray crosses its surface an even number of times. Takes
/// 24 bytes per triangle in `work`. Triangles that the grid's range clips do not count. Throws
/// OverMemory and Cancelled.
OddEdges find_odd_edges(const QuantizedMesh& mesh, Work work);

}  // namespace voxdag
