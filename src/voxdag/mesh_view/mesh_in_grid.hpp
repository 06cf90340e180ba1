#pragma once
/// Checks whether a mesh and voxels belong together.
#include "voxdag/core/grid.hpp"
#include "voxdag/layout/voxel_set.hpp"
#include "voxdag/mesh/mesh.hpp"

namespace voxdag {

/// Throws Error unless the mesh lies where the voxels are. Samples some thousand vertices, ignores
/// those outside of the grid, which the build may have clipped, and requires that nine in ten have
/// a voxel at most one voxel away.
void check_mesh_in_grid(const Mesh& mesh, const VoxelSet& scene, const Grid& grid);

}  // namespace voxdag
