#pragma once
/// Files that a mesh file names: MTL files, glTF buffers, textures.
#include <filesystem>
#include <string>
#include <string_view>

#include "voxdag/core/error_place.hpp"
#include "voxdag/formats/readers/mesh_source.hpp"

namespace voxdag {

/// The place of a name, for error messages.
struct NamePlace {
  std::string file;  ///< The mesh file, or the MTL file that it names.
  ErrorPlace place;  ///< "line 3", "buffers[0]".
};

class NamedFiles {
 public:
  explicit NamedFiles(const MeshSource& source);

  /// Returns `folder` / `name` and adds it to ReadOptions::named_files. The file need not exist.
  /// Throws Error if the path, with symbolic links resolved, is outside the mesh file's folder,
  /// unless ReadOptions::allow_outside is set.
  std::filesystem::path find(const std::filesystem::path& folder, std::string_view name,
                             const NamePlace& place) const;
  /// Adds a file that the reader does not open to ReadOptions::named_files.
  void report(const std::filesystem::path& path) const;

 private:
  const ReadOptions& options_;
  std::filesystem::path root_;  ///< The mesh file's folder, resolved.
};

/// Returns `folder` / `name` for error messages: long names are cut, control characters replaced.
std::string printable_path(const std::filesystem::path& folder, std::string_view name);

}  // namespace voxdag
