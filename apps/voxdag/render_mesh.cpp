#include "render_mesh.hpp"

#include "voxdag/deferred/mesh_in_grid.hpp"
#include "voxdag/deferred/mesh_view_source.hpp"
#include "voxdag/mesh/read_mesh.hpp"

namespace voxdag {

void add_mesh_options(CLI::App& command, MeshArguments& arguments) {
  command
      .add_option("--mesh", arguments.file,
                  "The mesh of the voxels: what is seen are its triangles, with smooth normals; "
                  "shadows and occlusion are the voxels'")
      ->type_name("MESH");
  command
      .add_option("--primary", arguments.primary,
                  "What is seen (default: the mesh if there is one)")
      ->check(CLI::IsMember({"voxels", "mesh"}))
      ->type_name("voxels|mesh");
}

void check_mesh_options(const MeshArguments& arguments) {
  if (arguments.primary == "mesh" && arguments.file.empty())
    throw CLI::ValidationError("--primary", "mesh needs --mesh");
}

std::unique_ptr<ViewSource> open_view_source(const MeshArguments& arguments, Vec3f albedo,
                                             const VoxelScene& scene, const Grid& grid,
                                             Session& session) {
  if (arguments.file.empty() || arguments.primary == "voxels") return nullptr;
  Mesh mesh = read_mesh(arguments.file, &session.progress);
  try {
    check_mesh_in_grid(mesh, scene, grid);
    MeshViewOptions options;
    options.albedo = albedo;
    return std::make_unique<MeshViewSource>(std::move(mesh), options);
  } catch (const Error& error) {
    throw Error(arguments.file, error.place(), error.reason());
  }
}

}  // namespace voxdag
