#pragma once
/// Opens a .vdag file of either kind, DAG or ESVO.
#include <filesystem>
#include <string>
#include <variant>

#include "voxdag/file/esvo_file.hpp"
#include "voxdag/file/vdag_file.hpp"
#include "voxdag/stored/svdag/voxel_set.hpp"

namespace voxdag {

/// Move-only; views stay valid when it is moved.
class SceneFile {
 public:
  /// Reads a .vdag or .esvo file. Throws Error(path, place, reason) if the file has neither format,
  /// or is damaged.
  explicit SceneFile(const std::filesystem::path& path) : file_(open(path)) {}

  /// Returns a view of the file's bytes, which this object owns.
  VoxelSet voxels() const {
    return std::visit([](const auto& file) { return VoxelSet(file.view()); }, file_);
  }
  const SceneMetadata& metadata() const {
    return std::visit([](const auto& file) -> const SceneMetadata& { return file.metadata(); },
                      file_);
  }
  const Grid& grid() const { return metadata().grid; }

 private:
  using File = std::variant<VdagFile, EsvoFile>;

  static File open(const std::filesystem::path& path) {
    if (is_esvo_file(path)) return File(std::in_place_type<EsvoFile>, path);
    return File(std::in_place_type<VdagFile>, path);
  }

  File file_;
};

}  // namespace voxdag
