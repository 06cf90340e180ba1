#pragma once
/// The files of the page, which the build embeds into the program.
#include <span>
#include <string_view>

namespace voxdag {

struct PageFile {
  std::string_view path;  ///< Path from the page's folder: "app/app.js", or "index.html".
  std::string_view type;  ///< Content-Type.
  std::string_view bytes;
};

/// Returns the files, sorted by path. They live as long as the program.
std::span<const PageFile> page_files();

/// Returns whether the page can build scenes: it has the program for browsers.
bool has_program(std::span<const PageFile> files);

/// Returns the file with this path, or null.
const PageFile* find_page_file(std::string_view path);

}  // namespace voxdag
