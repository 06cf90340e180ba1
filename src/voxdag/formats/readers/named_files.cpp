#include "voxdag/formats/readers/named_files.hpp"

#include <algorithm>

#include "voxdag/core/printable.hpp"

namespace voxdag {
namespace {

namespace fs = std::filesystem;

/// Returns the absolute path, with symbolic links resolved as far as it exists.
fs::path resolved(const fs::path& path) {
  std::error_code failed;
  // weakly_canonical() leaves a relative path relative if no part of it exists.
  fs::path result = fs::weakly_canonical(fs::absolute(path), failed);
  // A path that cannot be resolved (a loop of links, a name too long) cannot be opened either.
  return failed ? fs::absolute(path, failed).lexically_normal() : result;
}

bool is_inside(const fs::path& path, const fs::path& root) {
  return std::mismatch(root.begin(), root.end(), path.begin(), path.end()).first == root.end();
}

}  // namespace

NamedFiles::NamedFiles(const MeshSource& source)
    : options_(source.options), root_(resolved(source.folder.empty() ? "." : source.folder)) {}

fs::path NamedFiles::find(const fs::path& folder, std::string_view name,
                          const NamePlace& place) const {
  fs::path path = folder / name;
  if (!options_.allow_outside && !is_inside(resolved(path), root_))
    throw Error(place.file, place.place,
                name_in_quotes(name) + " is outside of the folder of the mesh file");
  report(path);
  return path;
}

void NamedFiles::report(const fs::path& path) const {
  if (options_.named_files != nullptr) options_.named_files->push_back(path);
}

std::string printable_path(const fs::path& folder, std::string_view name) {
  return (folder / printable(name)).string();
}

}  // namespace voxdag
