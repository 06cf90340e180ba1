#pragma once
/// Checks whether a mesh and voxels belong together.
#include "voxdag/core/grid.hpp"
#include "voxdag/mesh/mesh.hpp"
#include "voxdag/stored/svdag/voxel_set.hpp"

namespace voxdag {

/// Throws Error unless the mesh lies where the voxels are. Samples a few thousand vertices and
/// ignores those outside the grid, which the build may have clipped. Of the others, nine in ten
/// must be at most one voxel away from a voxel.
void check_mesh_in_grid(const Mesh& mesh, const VoxelSet& scene, const Grid& grid);

}  // namespace voxdag
