#include "voxdag/file/model/scene_model.hpp"

#include <utility>

#include "voxdag/core/error.hpp"
#include "voxdag/file/model/no_materials.hpp"

namespace voxdag {
namespace {

std::variant<DagModel, EsvoFile> open(VdagContainer file, Work work) {
  if (file.kind() == VdagKind::kEsvo) return EsvoFile(std::move(file));
  return DagModel(std::move(file), work);
}

}  // namespace

SceneModel::SceneModel(VdagContainer file, Work work) : scene_(open(std::move(file), work)) {}

VoxelSet SceneModel::voxels() const {
  return std::visit([](const auto& file) { return VoxelSet(file.view()); }, scene_);
}

ColoredDagView SceneModel::colored_dag() const {
  const DagModel* const dag = std::get_if<DagModel>(&scene_);
  return dag == nullptr ? ColoredDagView{} : ColoredDagView{dag->view(), dag->attributes()};
}

void SceneModel::show_materials(const std::filesystem::path& path, Work work) {
  DagModel* const dag = std::get_if<DagModel>(&scene_);
  if (dag == nullptr) fail_without_materials(path);
  dag->show_materials(path, work);
}

ChannelRange SceneModel::show_channel(const std::filesystem::path& path, const std::string& name,
                                      const std::optional<ChannelRange>& range, Work work) {
  DagModel* const dag = std::get_if<DagModel>(&scene_);
  if (dag == nullptr) throw Error(path.string(), "", "is an ESVO, which has no channels");
  return dag->show_channel(path, name, range, work);
}

const SceneMetadata& SceneModel::metadata() const {
  return std::visit([](const auto& file) -> const SceneMetadata& { return file.metadata(); },
                    scene_);
}

}  // namespace voxdag
