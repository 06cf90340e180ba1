#pragma once
/// `voxdag render --mesh`: view samples from triangles.
#include <memory>

#include "render/render_arguments.hpp"
#include "voxdag/render/view_source.hpp"

namespace voxdag::cli {

/// Returns the mesh as a source of view samples, or null if the picture shows voxels. Throws Error
/// if the voxels were not built from the mesh.
std::unique_ptr<ViewSource> open_view_source(const MeshArguments& arguments, Vec3f albedo,
                                             const VoxelSet& scene, const Grid& grid,
                                             Session& session);

}  // namespace voxdag::cli
