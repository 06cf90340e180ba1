#include "view/shown_scene.hpp"

#include <fmt/core.h>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/process_memory.hpp"
#include "voxdag/file/compact_file.hpp"
#include "voxdag/file/report/human.hpp"

namespace voxdag::cli {
namespace {

void refuse_esvo(const std::string& path) {
  if (is_esvo_file(path))
    throw Error(path, "",
                "is an ESVO, which the viewer cannot show: build a DAG with colours from its mesh, "
                "voxdag build MESH --color -o scene.vdag");
}

}  // namespace

ShownScene ShownScene::open(const std::string& path, const ShownSceneArguments& arguments,
                            Session& session) {
  refuse_esvo(path);
  if (is_compact_file(path)) {
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
  refuse_esvo(path);
  ShownScene scene;
  // make_unique() would need to move the budget, which cannot be moved.
  scene.memory_.reset(new MemoryBudget(command_budget(arguments.memory_limit)));
  scene.file_ = std::make_unique<DagModel>(path, &session.progress, scene.memory_.get());
  scene.dag_ = std::make_unique<ReducedDag>(*scene.file_, path, arguments.reduction,
                                            scene.memory_.get(), &session.progress);
  const DagAttributesView& attributes = scene.dag_->attributes();
  scene.coded_ = reserve_coded(attributes, form, scene.memory_.get());
  scene.bytes_ = make_scene_bytes(scene.dag_->dag(), scene.dag_->metadata(), attributes, form);
  return scene;
}

}  // namespace voxdag::cli
