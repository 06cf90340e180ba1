#pragma once
/// The meshes that `voxdag bench` builds from.
#include <array>
#include <filesystem>
#include <string>

#include "lab/papers/paper_scenes.hpp"
#include "lab/report/bench_child.hpp"

namespace voxdag::lab {

/// Returns the path of voxdag, which child processes run. Throws Error unless it lies beside this
/// program.
std::string voxdag_program();

/// Returns whether `mesh` is the name of a procedural scene, NAME or NAME:SIZE, and not a file.
bool is_procedural(const std::string& mesh);

/// A mesh file, ready to be read from memory.
struct PreparedMesh {
  std::filesystem::path path;
  MeshIdentity identity;  ///< Its `triangles` and `is_displaced` are known after a build.
};

/// Prepares the file of the mesh, which is made in `folder` if it is procedural. Reads the file
/// once, so that the next reader finds it in memory. Throws Error if it cannot be read or made, and
/// Cancelled.
PreparedMesh prepare_mesh(const std::string& mesh, const std::filesystem::path& folder,
                          Progress& progress);

}  // namespace voxdag::lab
