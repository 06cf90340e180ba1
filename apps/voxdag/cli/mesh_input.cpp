#include "cli/mesh_input.hpp"

#include <fmt/core.h>

#include <filesystem>
#include <stdexcept>

#include "cli/input_files.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/float_origin.hpp"
#include "voxdag/core/io/open_input.hpp"
#include "voxdag/core/with_file_name.hpp"
#include "voxdag/formats/readers/read_mesh.hpp"
#include "voxdag/mesh/join_meshes.hpp"
#include "voxdag/mesh/mesh_bounds.hpp"
#include "voxdag/mesh_view/mesh_in_grid.hpp"

namespace voxdag::cli {
namespace {

/// Returns whether `text` asks for all importers.
bool parse_importers(const std::string& text) {
  if (text != "any" && text != "safe")
    throw std::invalid_argument("\"" + text + "\" is neither safe nor any");
  return text == "any";
}

/// Gives all materials the colours of an image. Throws Error if the mesh has no texture
/// coordinates, or the image cannot be opened.
void set_texture(Appearance& appearance, const std::string& texture) {
  if (appearance.uvs.empty()) throw Error("has no texture coordinates, which --texture needs");
  open_input(texture);
  for (Material& material : appearance.materials) {
    material.color_map = {};
    material.color_map.image = static_cast<int>(appearance.images.size());
    material.texture_tint = {1, 1, 1};
  }
  appearance.images.push_back({texture, texture, {}});
}

/// Reads a mesh, moves it, and checks that it names no output.
MeshWithAppearance read_and_check(const std::string& file, bool with_appearance,
                                  const MeshAccess& access, Session& session) {
  std::vector<std::filesystem::path> named;
  ReadOptions options;
  options.work = {access.memory, &session.progress};
  access.give_rights(options);
  options.named_files = &named;
  MeshWithAppearance result;
  if (with_appearance)
    result = read_mesh_with_appearance(file, options);
  else {
    options.warnings = &result.warnings;
    result.mesh = read_mesh(file, options);
  }
  check_not_overwritten(access.outputs, named, file);
  print_warnings(result.warnings, session);
  result.warnings.clear();
  with_file_name(file, [&] {
    if (!access.texture.empty()) set_texture(result.appearance, access.texture);
    move_mesh(result, InputTransform(access.transform, mesh_custom(file, options)), options.work);
  });
  return result;
}

}  // namespace

void add_mesh_access_options(const Command& command, MeshAccess& access, const Option* mesh) {
  const Option format = command.text(
      "--format", access.format, "EXT",
      "Read the mesh as if its name ended in .EXT. Standard input needs it for formats that have "
      "no signature, such as OBJ");
  const Option outside = command.flag(
      "--allow-outside", access.allow_outside,
      "Let the mesh name textures, buffers and material libraries outside its own folder");
  const Option assimp = command.parsed(
      "--assimp", access.any_importer, parse_importers, "safe|any",
      "Where assimp reads FBX and others. safe: in a child process that can only compute; any: in "
      "this process, with the files that the mesh names (default: safe)");
  if (mesh == nullptr) return;
  for (const Option& option : {format, outside, assimp}) option.needs(*mesh);
}

Mesh read_mesh_file(const std::string& file, const MeshAccess& access, Session& session) {
  return read_and_check(file, false, access, session).mesh;
}

MeshWithAppearance read_mesh_file_with_appearance(const std::string& file, const MeshAccess& access,
                                                  Session& session) {
  return read_and_check(file, true, access, session);
}

JoinedMeshes read_mesh_files(const std::vector<std::string>& files, bool with_appearance,
                             const MeshAccess& access, Session& session) {
  JoinedMeshes joined;
  const std::vector<std::string> names = distinct_names(files);
  for (std::uint32_t i = 0; i < files.size(); ++i) {
    MeshWithAppearance read = read_and_check(files[i], with_appearance, access, session);
    if (files.size() > 1) name_parts(read, names[i], access.memory);
    joined.files.push_back({joined.source.mesh.triangles.size(), i});
    if (i == 0)
      joined.source = std::move(read);
    else
      with_file_name(files[i], [&] { append_mesh(joined.source, std::move(read), access.memory); });
  }
  return joined;
}

void warn_of_rounding(const std::string& file, const Mesh& mesh, double voxel_size,
                      Session& session) {
  warn_of_rounding(file, float_rounding(referenced_bounds(mesh), mesh.origin), voxel_size, session);
}

void warn_of_rounding(const std::string& file, double rounding, double voxel_size,
                      Session& session) {
  if (rounding <= voxel_size / 8) return;
  print_warnings(
      {fmt::format("{}: vertices, in float32, may be off by {:.2g}, and a voxel has {:.2g}: "
                   "parts of the mesh are far from each other or from 0",
                   file, rounding, voxel_size)},
      session);
}

void check_is_mesh_of(const std::string& file, const Mesh& mesh, const VoxelSet& scene,
                      const Grid& grid) {
  try {
    check_mesh_in_grid(mesh, scene, grid);
  } catch (const Error& error) {
    throw error.in_file(file);
  }
}

}  // namespace voxdag::cli
