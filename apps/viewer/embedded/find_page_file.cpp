#include <algorithm>

#include "viewer/embedded/page_files.hpp"

namespace voxdag {

const PageFile* find_page_file(std::string_view path) {
  const std::span<const PageFile> files = page_files();
  const auto found = std::lower_bound(
      files.begin(), files.end(), path,
      [](const PageFile& file, std::string_view wanted) { return file.path < wanted; });
  return found == files.end() || found->path != path ? nullptr : &*found;
}

bool has_program(std::span<const PageFile> files) {
  return std::any_of(files.begin(), files.end(),
                     [](const PageFile& file) { return file.path == "build/voxdag.js"; });
}

}  // namespace voxdag
