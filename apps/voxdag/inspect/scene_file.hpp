#pragma once
/// The file of a scene, a DAG or an ESVO, opened by what it holds.
#include <string>
#include <variant>

#include "voxdag/file/esvo_file.hpp"
#include "voxdag/file/vdag_file.hpp"
#include "voxdag/trace/voxel_scene.hpp"

namespace voxdag {

class SceneFile {
 public:
  /// Throws Error(path, place, reason) for a file that is neither or damaged.
  explicit SceneFile(const std::string& path) : file_(open(path)) {}

  /// Points into the file.
  VoxelScene scene() const {
    if (const auto* esvo = std::get_if<EsvoFile>(&file_)) return esvo->view();
    return std::get<VdagFile>(file_).view();
  }
  /// Of the mesh's file, or empty.
  const std::string& source_name() const {
    if (const auto* esvo = std::get_if<EsvoFile>(&file_)) return esvo->metadata().source.name;
    return std::get<VdagFile>(file_).metadata().source.name;
  }
  const Grid& grid() const {
    if (const auto* esvo = std::get_if<EsvoFile>(&file_)) return esvo->grid();
    return std::get<VdagFile>(file_).grid();
  }

 private:
  using File = std::variant<VdagFile, EsvoFile>;

  static File open(const std::string& path) {
    if (is_esvo_file(path)) return File(std::in_place_type<EsvoFile>, path);
    return File(std::in_place_type<VdagFile>, path);
  }

  File file_;
};

}  // namespace voxdag
