#pragma once
/// A scene of any kind: a DAG in either form, or an ESVO.
#include <filesystem>
#include <variant>

#include "voxdag/core/parallel/work.hpp"
#include "voxdag/file/esvo_file.hpp"
#include "voxdag/file/model/dag_model.hpp"
#include "voxdag/stored/attributes/look.hpp"
#include "voxdag/stored/svdag/voxel_set.hpp"

namespace voxdag {

/// A scene of any kind in memory. Move-only; views stay valid when it is moved.
class SceneModel {
 public:
  /// Reads a DAG like DagModel, or an ESVO.
  explicit SceneModel(const std::filesystem::path& path, Work work = {})
      : SceneModel(VdagContainer(path, work.memory), work) {}
  explicit SceneModel(VdagContainer file, Work work = {});

  VoxelSet voxels() const;
  /// Returns the DAG with its attributes; empty for an ESVO and a file without attributes.
  ColoredDagView colored_dag() const;
  const SceneMetadata& metadata() const;
  const Grid& grid() const { return metadata().grid; }
  /// Calls DagModel::show_materials(). Throws Error for an ESVO, which has no material ids.
  void show_materials(const std::filesystem::path& path, Work work = {});
  /// Calls DagModel::show_channel(). Throws Error for an ESVO, which has no channels.
  ChannelRange show_channel(const std::filesystem::path& path, const std::string& name,
                            const std::optional<ChannelRange>& range, Work work = {});

 private:
  std::variant<DagModel, EsvoFile> scene_;
};

}  // namespace voxdag
