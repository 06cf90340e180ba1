#include "cli/written_files.hpp"

#include <fmt/core.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>

#include "cli/output_files.hpp"
#include "voxdag/file/report/human.hpp"

namespace voxdag::cli {
namespace {

namespace fs = std::filesystem;

/// Returns the size of a file, or of the files in a folder; 0 of a pipe or a device.
std::uint64_t bytes_of(const fs::path& path) {
  std::error_code unknown;
  std::uint64_t bytes = 0;
  if (fs::is_regular_file(path, unknown)) bytes = fs::file_size(path, unknown);
  for (fs::recursive_directory_iterator it(path, unknown), end; !unknown && it != end;
       it.increment(unknown))
    if (it->is_regular_file(unknown)) bytes += it->file_size(unknown);
  return bytes;
}

}  // namespace

void print_written(const WrittenFiles& written, Session& session) {
  session.bar.clear();
  std::uint64_t bytes = 0;
  for (const std::string& file : written.files) bytes += bytes_of(file);
  const double seconds = session.watch.since_start();
  if (session.json) {
    nlohmann::ordered_json json = {{"files", written.files}, {"bytes", bytes}};
    for (const auto& [name, count] : written.counts) json[name] = count;
    json["seconds"] = seconds;
    fmt::print("{}", json_text(json));
    return;
  }
  if (session.quiet) return;
  std::string text =
      fmt::format("{}: {}", with_output_name(written.files.front()), human_bytes(bytes));
  for (const auto& [name, count] : written.counts)
    text += fmt::format(", {} {}", with_commas(count), name);
  if (!written.note.empty()) text += ", " + written.note;
  fmt::print("{}, {}\n", text, human_seconds(seconds));
  if (written.files.size() == 1) return;
  for (const std::string& file : written.files) fmt::print("  {}\n", file);
}

}  // namespace voxdag::cli
