#include "cli/mesh_input.hpp"

#include <filesystem>
#include <stdexcept>

#include "voxdag/core/error.hpp"
#include "voxdag/formats/readers/read_mesh.hpp"
#include "voxdag/mesh_view/mesh_in_grid.hpp"

namespace voxdag::cli {
namespace {

/// Returns whether `text` asks for all importers.
bool parse_importers(const std::string& text) {
  if (text != "any" && text != "safe")
    throw std::invalid_argument("\"" + text + "\" is neither safe nor any");
  return text == "any";
}

/// Calls read(options) and checks that the mesh names no output.
template <class Read>
auto read_and_check(const std::string& file, const MeshAccess& access, Session& session,
                    const Read& read) {
  std::vector<std::filesystem::path> named;
  ReadOptions options;
  options.work = {access.memory, &session.progress};
  access.give_rights(options);
  options.named_files = &named;
  auto result = read(options);
  check_not_overwritten(access.outputs, named, file);
  return result;
}

}  // namespace

void add_mesh_access_options(const Command& command, MeshAccess& access, const Option* mesh) {
  const Option format = command.text(
      "--format", access.format, "EXT",
      "Read the mesh as if its name ended in .EXT: for standard input of formats that do not tell "
      "themselves, such as OBJ");
  const Option outside = command.flag(
      "--allow-outside", access.allow_outside,
      "Let the mesh name textures, buffers and material libraries outside its own folder");
  const Option assimp = command.parsed(
      "--assimp", access.any_importer, parse_importers, "safe|any",
      "Formats that assimp may read. safe: those whose importers survived fuzzing; any: all "
      "(default: safe)");
  if (mesh == nullptr) return;
  for (const Option& option : {format, outside, assimp}) option.needs(*mesh);
}

Mesh read_mesh_file(const std::string& file, const MeshAccess& access, Session& session) {
  return read_and_check(file, access, session,
                        [&](const ReadOptions& options) { return read_mesh(file, options); });
}

MeshWithAppearance read_mesh_file_with_appearance(const std::string& file, const MeshAccess& access,
                                                  Session& session) {
  MeshWithAppearance read = read_and_check(file, access, session, [&](const ReadOptions& options) {
    return read_mesh_with_appearance(file, options);
  });
  print_warnings(read.warnings, session);
  return read;
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
