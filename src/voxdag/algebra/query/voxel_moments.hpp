#pragma once
/// The bounding box and the centre of mass of a DAG's voxels.
#include <cstdint>

#include "voxdag/core/box.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

struct VoxelMoments {
  std::uint64_t voxels = 0;
  Box3i bounds{};  ///< The first voxel, and one past the last on each axis; empty: all 0.
  Vec3d centre{};  ///< Mean of the centres of the voxels, in voxels, rounded once; empty: 0.
};

/// VoxelMoments::bounds alone: less time, and a quarter of the memory.
Box3i bounds_of(const SvdagView& dag, Work work);

/// Time and memory (80 bytes per node of two levels) grow with the nodes, not with the voxels.
/// Throws OverMemory and Cancelled.
VoxelMoments moments_of(const SvdagView& dag, Work work);

}  // namespace voxdag
