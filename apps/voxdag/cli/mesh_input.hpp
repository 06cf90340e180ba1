#pragma once
/// Reads the mesh files of commands, and declares the options for it.
#include <string>
#include <vector>

#include "cli/output_files.hpp"
#include "cli/session.hpp"
#include "voxdag/core/grid.hpp"
#include "voxdag/formats/readers/read_mesh.hpp"
#include "voxdag/formats/readers/read_options.hpp"
#include "voxdag/mesh/input_transform.hpp"
#include "voxdag/stored/svdag/voxel_set.hpp"

namespace voxdag::cli {

/// The rights of readers of the command line's mesh files.
struct MeshAccess {
  bool allow_outside = false;       ///< As ReadOptions::allow_outside.
  bool any_importer = false;        ///< As ReadOptions::any_assimp_importer.
  bool objects = false;             ///< As ReadOptions::objects.
  std::string format;               ///< As ReadOptions::format.
  std::string texture;              ///< The image of all materials; empty: those of the mesh.
  TransformRequest transform;       ///< Moves each mesh, by the customs of its format.
  MemoryBudget* memory = nullptr;   ///< The budget of ReadOptions::work.
  std::vector<OutputFile> outputs;  ///< Files that the command writes: no mesh may name them.

  /// Sets the rights of a reader.
  void give_rights(ReadOptions& options) const {
    options.allow_outside = allow_outside;
    options.any_assimp_importer = any_importer;
    options.objects = objects;
    options.format = format;
  }
  /// Returns the up axis and the unit of a mesh's coordinates.
  FormatCustom custom_of(const std::string& file) const {
    ReadOptions options;
    give_rights(options);
    return mesh_custom(file, options);
  }
};

/// Adds --format, --allow-outside and --assimp. `mesh` is the option that names the mesh, if it is
/// optional.
void add_mesh_access_options(const Command& command, MeshAccess& access,
                             const Option* mesh = nullptr);

/// Reads a mesh, moves it, and prints the warnings. Throws Error, also if the mesh names one of the
/// outputs.
Mesh read_mesh_file(const std::string& file, const MeshAccess& access, Session& session);

/// Reads a mesh and its appearance, and prints the warnings. Throws Error like read_mesh_file().
MeshWithAppearance read_mesh_file_with_appearance(const std::string& file, const MeshAccess& access,
                                                  Session& session);

/// The meshes of several files in one.
struct JoinedMeshes {
  MeshWithAppearance source;
  std::vector<ObjectRun> files;  ///< The triangles of each file; ObjectRun::object is its index.
};
/// Reads meshes, with their appearance if `with_appearance`, and joins them with append_mesh(). If
/// there are several files, name_parts() gives distinct_names() to their materials and objects.
JoinedMeshes read_mesh_files(const std::vector<std::string>& files, bool with_appearance,
                             const MeshAccess& access, Session& session);

/// Warns if float32 rounds the vertices of the mesh by more than an eighth of a voxel: its parts
/// are far from each other, and the voxels small. `rounding` is float_rounding() of the mesh.
void warn_of_rounding(const std::string& file, double rounding, double voxel_size,
                      Session& session);
void warn_of_rounding(const std::string& file, const Mesh& mesh, double voxel_size,
                      Session& session);

/// Throws Error(file, ...) unless the voxels were built from this mesh, which was read from `file`.
void check_is_mesh_of(const std::string& file, const Mesh& mesh, const VoxelSet& scene,
                      const Grid& grid);

}  // namespace voxdag::cli
