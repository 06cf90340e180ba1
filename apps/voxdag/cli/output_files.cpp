#include "cli/output_files.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <map>

#include "cli/input_files.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/io/resolved_output.hpp"
#include "voxdag/core/io/unpacked_name.hpp"

namespace voxdag::cli {
namespace {

namespace fs = std::filesystem;

bool is_device(const fs::path& path) {
  std::error_code unknown;
  return fs::is_other(path, unknown);
}

/// Keeps the path that standard_output() returned; it is empty before the first call.
std::string& standard_output_path() {
  static std::string path;
  return path;
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
  return standard_output_path() = output_path_of(output).string();
}

bool is_standard_output(const std::string& path) {
  return !path.empty() && path == standard_output_path();
}

std::string with_output_name(std::string text) {
  const std::string& path = standard_output_path();
  constexpr std::string_view kName = "standard output";
  for (std::size_t at = 0; !path.empty() && (at = text.find(path, at)) != text.npos;) {
    const std::size_t end = at + path.size();
    if (end < text.size() && text[end] >= '0' && text[end] <= '9') {
      at = end;  // the path of another descriptor
    } else {
      text.replace(at, path.size(), kName);
      at += kName.size();
    }
  }
  return text;
}

bool is_pipe_or_device(const std::string& output) {
  std::error_code unknown;
  return resolve_output(output).descriptor >= 0 || fs::is_other(output, unknown);
}

std::string default_output(const std::string& argument, const std::string& file,
                           const std::string& ending) {
  std::error_code unknown;
  const std::string& input = fs::exists(argument, unknown) ? argument : file;
  fs::path name = fs::absolute(unpacked_name(input)).lexically_normal();
  if (!name.has_filename()) name = name.parent_path();
  if (input == "-" || is_pipe_or_device(input) || name.stem().empty())
    throw UsageError("--output", "is required: the input has no name");
  const std::string output = name.stem().string() + ending;
  const bool is_picture = ending == ".png";  // It may be a texture of the input.
  if (fs::exists(output, unknown) && (is_picture || !is_container(output)))
    throw UsageError("--output", fmt::format("is required: {} exists{}", output,
                                             is_picture ? "" : ", and is no .vdag or .esvo file"));
  return output;
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
