#pragma once
/// The surface of a DAG's voxels.
#include <cstdint>

#include "voxdag/core/parallel/work.hpp"
#include "voxdag/core/vec.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

/// Counts of voxels and of their faces.
struct VoxelSurface {
  std::uint64_t voxels = 0;
  /// The faces across x, y and z between a voxel and an empty place or the outside of the grid.
  std::uint64_t faces[3] = {};

  std::uint64_t all_faces() const { return faces[0] + faces[1] + faces[2]; }
};

/// Time grows with the nodes, not with the voxels: two neighbours along an axis are a voxel of the
/// DAG and one of the DAG moved by a voxel. Throws OverMemory and Cancelled.
VoxelSurface surface_of(const SvdagView& dag, Work work);

}  // namespace voxdag
