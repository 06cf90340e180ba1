#include "render/render_mesh.hpp"

#include "voxdag/mesh_view/mesh_in_grid.hpp"
#include "voxdag/mesh_view/mesh_view_source.hpp"
#include "voxdag/readers/read_mesh.hpp"

namespace voxdag {

void add_mesh_options(CLI::App& command, MeshArguments& arguments) {
  CLI::Option* const mesh =
      command
          .add_option("--mesh", arguments.file,
                      "The mesh of the voxels: what is seen are its triangles, with their colours, "
                      "textures and normals; shadows and occlusion are the voxels'")
          ->type_name("MESH");
  command
      .add_flag("--grey", arguments.grey,
                "Show the mesh in one grey, with normals of its triangles")
      ->needs(mesh);
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

void check_is_mesh_of(const std::string& file, const Mesh& mesh, const VoxelScene& scene,
                      const Grid& grid) {
  try {
    check_mesh_in_grid(mesh, scene, grid);
  } catch (const Error& error) {
    throw Error(file, error.place(), error.reason());
  }
}

std::unique_ptr<ViewSource> open_view_source(const MeshArguments& arguments, Vec3f albedo,
                                             const VoxelScene& scene, const Grid& grid,
                                             Session& session) {
  if (arguments.file.empty() || arguments.primary == "voxels") return nullptr;
  MeshWithAppearance source;
  if (arguments.grey)
    source.mesh = read_mesh(arguments.file, &session.progress);
  else
    source = read_mesh_with_appearance(arguments.file, &session.progress);
  print_warnings(source.warnings, session);
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
    throw Error(arguments.file, error.place(), error.reason());
  }
}

}  // namespace voxdag
