#include "render/render_mesh.hpp"

#include "voxdag/core/error.hpp"
#include "voxdag/mesh_view/mesh_view_source.hpp"

namespace voxdag::cli {

std::unique_ptr<ViewSource> open_view_source(const MeshArguments& arguments, Vec3f albedo,
                                             const VoxelSet& scene, const Grid& grid,
                                             Session& session) {
  if (!arguments.is_seen()) return nullptr;
  MeshWithAppearance source;
  if (arguments.grey)
    source.mesh = read_mesh_file(arguments.file, arguments.access, session);
  else
    source = read_mesh_file_with_appearance(arguments.file, arguments.access, session);
  check_is_mesh_of(arguments.file, source.mesh, scene, grid);
  try {
    MeshViewOptions options;
    options.albedo = albedo;
    if (arguments.grey) return std::make_unique<MeshViewSource>(std::move(source.mesh), options);
    std::vector<std::string> warnings;
    auto view_source =
        std::make_unique<MeshViewSource>(std::move(source.mesh), std::move(source.appearance),
                                         options, &warnings, &session.progress);
    print_warnings(warnings, session);
    return view_source;
  } catch (const Error& error) {
    throw error.in_file(arguments.file);
  }
}

}  // namespace voxdag::cli
