#include "cli/input_files.hpp"

#include <fmt/format.h>
#include <glob.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "cli/usage_error.hpp"
#include "voxdag/core/lower_case.hpp"
#include "voxdag/core/with_file_name.hpp"
#include "voxdag/file/esvo_parse.hpp"
#include "voxdag/file/vdag_container.hpp"
#include "voxdag/file/vdag_format.hpp"

namespace voxdag::cli {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> matches_of(const std::string& pattern) {
  glob_t found{};
  std::vector<std::string> files;
  if (glob(pattern.c_str(), 0, nullptr, &found) == 0)
    files.assign(found.gl_pathv, found.gl_pathv + found.gl_pathc);
  globfree(&found);
  return files;
}

}  // namespace

std::vector<std::string> files_in(const std::string& folder,
                                  const std::vector<std::string>& endings) {
  std::vector<std::string> files;
  std::error_code unknown;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, unknown)) {
    const std::string name = lower_case(entry.path().filename().string());
    // Systems keep notes beside files: macOS has ._scan.ply beside scan.ply.
    if (!name.starts_with('.') &&
        std::any_of(endings.begin(), endings.end(),
                    [&](const std::string& ending) { return name.ends_with(ending); }))
      files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<std::string> expand_inputs(const std::vector<std::string>& arguments,
                                       const std::vector<std::string>& endings) {
  std::vector<std::string> files;
  for (const std::string& argument : arguments) {
    std::error_code unknown;
    std::vector<std::string> found;
    if (fs::is_directory(argument, unknown)) {
      found = files_in(argument, endings);
      if (found.empty())
        throw UsageError(fmt::format("the folder {} has no file that ends in {}", argument,
                                     fmt::join(endings, ", ")));
    } else if (argument.find_first_of("*?[") != argument.npos && !fs::exists(argument, unknown)) {
      found = matches_of(argument);
    }
    if (found.empty()) found = {argument};
    files.insert(files.end(), found.begin(), found.end());
  }
  return files;
}

bool is_container(const std::string& path) {
  std::error_code unknown;
  if (!fs::is_regular_file(path, unknown)) return false;
  char magic[sizeof kVdagMagic];
  std::ifstream file(path, std::ios::binary);
  return file.read(magic, sizeof magic) && std::memcmp(magic, kVdagMagic, sizeof magic) == 0;
}

Grid grid_of_file(const std::string& path) {
  const VdagContainer file(path);
  const std::vector<VdagChunk> chunks = file.chunks();
  return with_file_name(path, [&] {
    return file.kind() == VdagKind::kEsvo ? read_esvo_metadata(chunks).grid
                                          : read_vdag_metadata(chunks).grid;
  });
}

std::string names_of(const std::vector<std::string>& files) {
  constexpr std::size_t kMax = 4;
  std::string names;
  for (std::size_t i = 0; i < std::min(files.size(), kMax); ++i)
    names += (i == 0 ? "" : ", ") + fs::path(files[i]).filename().string();
  return files.size() <= kMax ? names : fmt::format("{} and {} more", names, files.size() - kMax);
}

std::vector<std::string> distinct_names(const std::vector<std::string>& files) {
  std::vector<std::string> short_names, names;
  for (const std::string& file : files) short_names.push_back(fs::path(file).filename().string());
  for (std::size_t i = 0; i < files.size(); ++i)
    names.push_back(std::count(short_names.begin(), short_names.end(), short_names[i]) > 1
                        ? files[i]
                        : short_names[i]);
  return names;
}

}  // namespace voxdag::cli
