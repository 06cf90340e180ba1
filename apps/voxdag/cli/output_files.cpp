#include "cli/output_files.hpp"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <map>

#include "voxdag/io/resolved_output.hpp"

namespace voxdag {
namespace {

namespace fs = std::filesystem;

bool is_device(const fs::path& path) {
  std::error_code unknown;
  return fs::is_other(path, unknown);
}

}  // namespace

fs::path place_of(const std::string& path) {
  std::error_code unknown;
  const fs::path file = resolve_output(path).file;
  const fs::path place = fs::weakly_canonical(fs::absolute(file, unknown), unknown);
  return unknown ? fs::path(path).lexically_normal() : place;
}

bool are_same_file(const std::string& a, const std::string& b) {
  std::error_code unknown;
  return fs::equivalent(a, b, unknown) && !unknown;
}

void check_distinct(const std::vector<OutputFile>& outputs, const Session& session) {
  const auto check_input = [](const OutputFile& output, const std::string& input) {
    if (are_same_file(output.path, input))
      throw CLI::ValidationError(output.option, "would overwrite " + input + ", which is read");
  };
  std::map<fs::path, std::string> writers;
  for (const OutputFile& output : outputs) {
    if (output.path.empty() || is_device(output.path)) continue;
    check_input(output, session.subject);
    for (const std::string& input : session.inputs) check_input(output, input);
    const auto [writer, is_new] = writers.emplace(place_of(output.path), output.option);
    if (!is_new)
      throw CLI::ValidationError(output.option,
                                 "would overwrite " + output.path + " of " + writer->second);
  }
}

}  // namespace voxdag
