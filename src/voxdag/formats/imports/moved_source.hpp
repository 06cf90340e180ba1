#pragma once
/// Sources whose points or voxels are moved, and several sources in one.
#include <memory>
#include <vector>

#include "voxdag/formats/imports/voxel_source.hpp"
#include "voxdag/mesh/input_transform.hpp"

namespace voxdag {

/// Returns the source with its points moved, or with its voxels turned and their grid moved; the
/// source itself if the transform moves nothing. Throws Error for voxels if the transform turns
/// axes by other angles than quarters, or if it scales or moves voxels whose file does not say
/// where they lie.
std::unique_ptr<VoxelSource> moved_source(std::unique_ptr<VoxelSource> source,
                                          const InputTransform& transform);

/// Returns one source of the points or the voxels of several, at least one, in their order. Where
/// only some have colours, the others are grey. Voxels lie in one grid: sources that name grids
/// must all do so, and their voxels must coincide (algebra/align_grids.hpp). Throws Error if they
/// do not, and for points beside voxels.
std::unique_ptr<VoxelSource> joined_source(std::vector<std::unique_ptr<VoxelSource>> sources);

}  // namespace voxdag
