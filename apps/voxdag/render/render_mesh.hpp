#pragma once
/// `voxdag render --mesh`: view samples from triangles.
#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "cli/session.hpp"
#include "voxdag/core/grid.hpp"
#include "voxdag/layout/voxel_set.hpp"
#include "voxdag/mesh/mesh.hpp"
#include "voxdag/render/view_source.hpp"

namespace voxdag {

struct MeshArguments {
  std::string file;     ///< Empty: none.
  bool grey = false;    ///< Leave out its colours, textures and normals.
  std::string primary;  ///< "mesh", "voxels" or empty: mesh where there is one.
};

void add_mesh_options(CLI::App& command, MeshArguments& arguments);

/// Throws CLI::ValidationError where --primary mesh has no mesh.
void check_mesh_options(const MeshArguments& arguments);

/// Throws Error(file, ...) unless the mesh, which was read from the file, is that of the voxels.
void check_is_mesh_of(const std::string& file, const Mesh& mesh, const VoxelSet& scene,
                      const Grid& grid);

/// The mesh as a source of view samples, or null where the voxels are to be seen. Throws Error for
/// a mesh that is not that of the voxels.
std::unique_ptr<ViewSource> open_view_source(const MeshArguments& arguments, Vec3f albedo,
                                             const VoxelSet& scene, const Grid& grid,
                                             Session& session);

}  // namespace voxdag
