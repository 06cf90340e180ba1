#pragma once
/// The summary of a command that writes files.
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "cli/session.hpp"

namespace voxdag::cli {

struct WrittenFiles {
  std::vector<std::string> files;  ///< Files or folders; at least one.
  std::vector<std::pair<std::string, std::uint64_t>> counts = {};  ///< {"voxels", 12}.
  std::string note = {};  ///< Of the text, such as "plain form"; may be empty.
};

/// Prints the name, size and counts of the files and the seconds since the program began, as one
/// line of text or, with --json, as JSON. Lists the files if they are several. Prints no text with
/// --quiet.
void print_written(const WrittenFiles& written, Session& session);

}  // namespace voxdag::cli
