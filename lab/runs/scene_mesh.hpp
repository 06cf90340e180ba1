#pragma once
/// The voxdag that is measured, and the meshes that it reads.
#include <filesystem>
#include <string>

#include "voxdag/core/parallel/progress.hpp"

namespace voxdag::lab {

/// Returns the path of voxdag, which child processes run. Throws Error unless it lies beside this
/// program.
std::string voxdag_program();

/// A mesh file, ready to be read from memory.
struct SceneMesh {
  std::string name;  ///< Of the file, or of the procedural scene.
  std::filesystem::path path;
};

/// Prepares a mesh: a file, or a procedural scene as NAME or NAME:SIZE, which is made in `folder`.
/// Throws Error if it cannot be made, and Cancelled.
SceneMesh prepare_mesh(const std::string& mesh, const std::filesystem::path& folder,
                       Progress& progress);

}  // namespace voxdag::lab
