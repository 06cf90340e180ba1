#pragma once
/// The meshes that `voxdag bench` builds from.
#include <array>
#include <filesystem>
#include <string>

#include "bench/report/bench_child.hpp"

namespace voxdag {

/// Returns the path of this program, for child processes.
std::string this_program();

/// Whether `mesh` is not a file but the name of a procedural scene, NAME or NAME:SIZE.
bool is_procedural(const std::string& mesh);

/// Returns the file of the mesh, which is made in `folder` if it is procedural. Reads the file
/// once, so that the next reader finds it in memory. Throws Error if it cannot be read or made, and
/// Cancelled.
std::filesystem::path prepare_mesh(const std::string& mesh, const std::filesystem::path& folder,
                                   Progress& progress);

}  // namespace voxdag
