#include "cli/output_files.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <map>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/resolved_output.hpp"

namespace voxdag::cli {
namespace {

namespace fs = std::filesystem;

bool is_device(const fs::path& path) {
  std::error_code unknown;
  return fs::is_other(path, unknown);
}

void check_input(const OutputFile& output, const std::string& input) {
  if (are_same_file(output.path, input))
    throw UsageError(output.option, fmt::format("would overwrite {}, an input file", input));
}

}  // namespace

std::string standard_output() {
  static const int output = [] {
    const int copy = dup(STDOUT_FILENO);
    if (copy >= 0) dup2(STDERR_FILENO, STDOUT_FILENO);
    return copy;
  }();
  return output_path_of(output);
}

fs::path canonical_output(const std::string& path) {
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
  std::map<fs::path, std::string> writers;
  for (const OutputFile& output : outputs) {
    if (output.path.empty() || is_device(output.path)) continue;
    check_input(output, session.subject);
    for (const std::string& input : session.inputs) check_input(output, input);
    const auto [writer, is_new] = writers.emplace(canonical_output(output.path), output.option);
    if (!is_new)
      throw UsageError(output.option, fmt::format("would overwrite {}, which {} writes",
                                                  output.path, writer->second));
  }
}

void check_not_overwritten(const std::vector<OutputFile>& outputs, std::span<const fs::path> files,
                           const std::string& namer) {
  for (const OutputFile& output : outputs) {
    if (output.path.empty() || is_device(output.path)) continue;
    for (const fs::path& file : files)
      if (are_same_file(output.path, file.string()))
        throw Error(
            output.path, "",
            fmt::format("{} would overwrite this file, which {} names", output.option, namer));
  }
}

}  // namespace voxdag::cli
