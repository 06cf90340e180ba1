#pragma once
/// Mesh files that commands read, and the options for that.
#include <string>
#include <vector>

#include "cli/output_files.hpp"
#include "cli/session.hpp"
#include "voxdag/core/grid.hpp"
#include "voxdag/layout/voxel_set.hpp"
#include "voxdag/readers/read_mesh.hpp"
#include "voxdag/readers/read_options.hpp"

namespace voxdag {

/// What readers may do with mesh files of the command line.
struct MeshAccess {
  bool allow_outside = false;       ///< As ReadOptions::allow_outside.
  bool any_importer = false;        ///< As ReadOptions::any_assimp_importer.
  MemoryBudget* memory = nullptr;   ///< As ReadOptions::memory.
  std::vector<OutputFile> outputs;  ///< The command writes them: no mesh may name them.
};

/// Adds --allow-outside and --assimp. `mesh` is the option of the mesh, if it can be left out.
void add_mesh_access_options(const Command& command, MeshAccess& access,
                             const Option* mesh = nullptr);

/// Reads a mesh. Throws Error, also if the mesh names one of the outputs.
Mesh read_mesh_file(const std::string& file, const MeshAccess& access, Session& session);

/// Reads a mesh and its appearance, and prints the warnings. Throws Error like read_mesh_file().
MeshWithAppearance read_mesh_file_with_appearance(const std::string& file, const MeshAccess& access,
                                                  Session& session);

/// Throws Error(file, ...) unless the mesh, which was read from `file`, is the one of the voxels.
void check_is_mesh_of(const std::string& file, const Mesh& mesh, const VoxelSet& scene,
                      const Grid& grid);

}  // namespace voxdag
