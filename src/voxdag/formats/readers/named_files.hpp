#pragma once
/// Files that a mesh file names: MTL files, glTF buffers, textures.
///
/// Many names were written on another system: with `\`, in quotes, in other letter case, with
/// `%20`, in Latin-1, or absolute. A name that exists as it stands counts; else `\` separates
/// folders, quotes are left out, and letter case does not matter. If that does not exist either, a
/// file with the same last folders and base name, as many as possible, may stand for it
/// (ByBaseName): in the folder of the file that names it, or of the mesh file.
#include <filesystem>
#include <optional>
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

  /// The names for which the file with the same end may stand: base name, and folders before it.
  enum class ByBaseName { kNever, kIfAbsolute, kAlways };

  /// Returns the file that `name`, relative to `folder`, stands for, if it exists. Its path, with
  /// symbolic links resolved, is in the mesh file's folder, unless ReadOptions::allow_outside is
  /// set.
  std::optional<std::filesystem::path> existing(const std::filesystem::path& folder,
                                                std::string_view name,
                                                ByBaseName by_base_name) const;
  /// Returns existing(), or else `folder` / `name`, and adds it to ReadOptions::named_files. Throws
  /// Error if the latter is outside the mesh file's folder, unless ReadOptions::allow_outside is
  /// set, or if it is no path.
  std::filesystem::path find(const std::filesystem::path& folder, std::string_view name,
                             const NamePlace& place,
                             ByBaseName by_base_name = ByBaseName::kAlways) const;
  /// Adds a file to ReadOptions::named_files.
  void report(const std::filesystem::path& path) const;
  /// Returns a warning if find() found files by their base names.
  std::optional<std::string> warning(const std::string& file) const;

 private:
  bool is_allowed(const std::filesystem::path& path) const;
  std::optional<std::filesystem::path> with_end_of(const std::filesystem::path& folder,
                                                   std::string_view name) const;

  const ReadOptions& options_;
  std::filesystem::path folder_;        ///< The mesh file's.
  std::filesystem::path root_;          ///< `folder_`, resolved.
  mutable std::size_t base_names_ = 0;  ///< Names that find() found by base name.
  mutable std::string first_base_name_;
};

/// Returns `folder` / `name` for error messages: long names are cut, control characters replaced.
std::string printable_path(const std::filesystem::path& folder, std::string_view name);

}  // namespace voxdag
