#pragma once
/// The meshes that `voxdag bench` builds from, and what its child processes have in common.
#include <array>
#include <filesystem>
#include <string>

#include "bench/report/bench_child.hpp"

namespace voxdag {

/// The path of this program, for child processes.
std::string this_program();

/// "a.obj: line 3: ...", how the child ended, or empty where it did not fail.
std::string failure_of(const ChildResult& result, double seconds_limit);

/// Whether `mesh` is no file but the name of a procedural scene, NAME or NAME:SIZE.
bool is_procedural(const std::string& mesh);

/// The mesh's file, made in `folder` where it is procedural, and read once, so that the next reader
/// finds it in memory. Throws Error where it cannot be read or made, and Cancelled.
std::filesystem::path prepare_mesh(const std::string& mesh, const std::filesystem::path& folder,
                                   Progress& progress);

}  // namespace voxdag
