#pragma once
/// The input files that a command line names: files, folders and patterns.
#include <string>
#include <vector>

#include "voxdag/core/grid.hpp"

namespace voxdag::cli {

/// Returns the files in a folder whose names end in one of `endings`, in any case, sorted by name.
/// Empty if `folder` is no folder.
std::vector<std::string> files_in(const std::string& folder,
                                  const std::vector<std::string>& endings);

/// Returns the files that arguments name: files_in() of a folder, and the files that match a
/// pattern with *, ? or [. Other arguments are files. Throws UsageError for a folder without such
/// files.
std::vector<std::string> expand_inputs(const std::vector<std::string>& arguments,
                                       const std::vector<std::string>& endings);

/// Returns whether the path is a regular file that begins like a .vdag or .esvo file.
bool is_container(const std::string& path);

/// Returns the grid of a .vdag or .esvo file. Throws Error.
Grid grid_of_file(const std::string& path);

/// Returns the names of the files without their folders: "a.obj, b.glb"; of more than four files,
/// the first four names and the number of the others.
std::string names_of(const std::vector<std::string>& files);

/// Returns a name for each file: without its folder, but as it was given if two names are equal.
std::vector<std::string> distinct_names(const std::vector<std::string>& files);

}  // namespace voxdag::cli
