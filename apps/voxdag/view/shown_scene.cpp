#include "view/shown_scene.hpp"

#include <fmt/core.h>

#include <utility>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/process_memory.hpp"
#include "voxdag/file/model/seeded.hpp"
#include "voxdag/file/report/human.hpp"
#include "voxdag/file/vdag_container.hpp"

namespace voxdag::cli {
namespace {

void refuse_esvo(VdagKind kind, const std::string& path) {
  if (kind == VdagKind::kEsvo)
    throw Error(path, "",
                "is an ESVO, which the viewer cannot show: build a DAG with colours from its mesh, "
                "voxdag build MESH --color -o scene.vdag");
}

}  // namespace

ShownScene ShownScene::open(const std::string& path, const ShownSceneArguments& arguments,
                            Session& session) {
  const VdagKind kind = vdag_kind(path);
  refuse_esvo(kind, path);
  if (kind == VdagKind::kCompact) {
    ShownScene scene = read(path, arguments, AttributeForm::kPages, session);
    session.bar.clear();
    if (!session.quiet)
      print_line(
          fmt::format("{}: is compact; decoded to {}", path, human_bytes(scene.bytes().size())));
    return scene;
  }
  ShownScene scene;
  scene.bytes_ = open_scene_bytes(path);
  return scene;
}

ShownScene ShownScene::read(const std::string& path, const ShownSceneArguments& arguments,
                            AttributeForm form, Session& session) {
  ShownScene scene;
  // make_unique() would need to move the budget, which cannot be moved.
  scene.memory_.reset(new MemoryBudget(command_budget(arguments.memory_limit)));
  const Work work(scene.memory_.get(), &session.progress);
  VdagContainer opened(path, work.memory);
  refuse_esvo(opened.kind(), path);
  scene.file_ = std::make_unique<DagModel>(std::move(opened), work);
  const SvdagCounts counts = scene.file_->metadata().counts;
  scene.is_seeded_ = arguments.for_edits && scene.file_->view().is_empty();
  if (scene.is_seeded_) *scene.file_ = seeded(*scene.file_, work);
  scene.dag_ = std::make_unique<ReducedDag>(*scene.file_, path, arguments.reduction, work);
  const DagAttributesView& attributes = scene.dag_->attributes();
  scene.coded_ = reserve_coded(attributes, form, work.memory);
  VdagMetadata metadata = scene.dag_->metadata();
  if (scene.is_seeded_) metadata.counts = counts;  // The page shows those of the file.
  scene.bytes_ = make_scene_bytes(scene.dag_->dag(), metadata, attributes, form);
  return scene;
}

}  // namespace voxdag::cli
