#pragma once
/// Reads the table of allowed includes and finds the edges of a source tree that break it.
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace voxdag {

/// Folder to the folders it may include, itself among them; transitively closed.
using IncludeRules = std::map<std::string, std::set<std::string>>;

/// Parses lines of "folder: allowed allowed ..."; '#' opens a comment line.
/// Throws std::runtime_error on a name that the table does not define.
IncludeRules read_include_rules(const std::filesystem::path& table);

/// One line, "folder/file.hpp:12: includes voxdag/mesh/mesh.hpp", for every include of `voxdag/...`
/// in the sources under `root` that the rules do not allow or that names no file, and for every
/// folder that the rules do not name.
std::vector<std::string> broken_includes(const std::filesystem::path& root,
                                         const IncludeRules& rules);

}  // namespace voxdag
