#include "output_files.hpp"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <map>

namespace voxdag {
namespace {

namespace fs = std::filesystem;

/// The same for all ways to write a path.
fs::path place_of(const std::string& path) {
  std::error_code unknown;
  const fs::path place = fs::weakly_canonical(fs::absolute(path, unknown), unknown);
  return unknown ? fs::path(path).lexically_normal() : place;
}

bool is_device(const fs::path& path) {
  std::error_code unknown;
  return fs::is_other(path, unknown);
}

}  // namespace

void check_distinct(const std::vector<OutputFile>& outputs) {
  std::map<fs::path, std::string> writers;
  for (const OutputFile& output : outputs) {
    if (output.path.empty() || is_device(output.path)) continue;
    const auto [writer, is_new] = writers.emplace(place_of(output.path), output.option);
    if (!is_new)
      throw CLI::ValidationError(output.option,
                                 "would overwrite " + output.path + " of " + writer->second);
  }
}

}  // namespace voxdag
