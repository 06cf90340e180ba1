#pragma once
/// Whether a mesh and a DAG belong together.
#include "voxdag/core/grid.hpp"
#include "voxdag/layout/voxel_set.hpp"
#include "voxdag/mesh/mesh.hpp"

namespace voxdag {

/// Throws Error unless the mesh lies where the voxels are: a sample of some thousand vertices is
/// looked up, those outside of the grid are left out (the build may have cut them off), and nine in
/// ten must have a voxel at most one voxel away.
void check_mesh_in_grid(const Mesh& mesh, const VoxelSet& scene, const Grid& grid);

}  // namespace voxdag
