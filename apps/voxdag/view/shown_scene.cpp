#include "view/shown_scene.hpp"

#include <fmt/core.h>

#include "voxdag/compact/coarsen.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/file/compact_file.hpp"
#include "voxdag/io/process_memory.hpp"
#include "voxdag/report/human.hpp"

namespace voxdag {
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
    ShownScene scene = read(path, arguments, session);
    session.bar.clear();
    if (!session.quiet)
      print_line(fmt::format("{}: is compact, and is decoded to {}", path,
                             human_bytes(scene.bytes().size())));
    return scene;
  }
  ShownScene scene;
  scene.bytes_ = open_scene_bytes(path);
  return scene;
}

ShownScene ShownScene::read(const std::string& path, const ShownSceneArguments& arguments,
                            Session& session) {
  refuse_esvo(path);
  ShownScene scene;
  scene.memory_ =
      std::unique_ptr<MemoryBudget>(new MemoryBudget(command_budget(arguments.memory_limit)));
  scene.file_ = std::make_unique<DagInput>(path, &session.progress, scene.memory_.get());
  SvdagView dag = scene.file_->view();
  VdagMetadata metadata = scene.file_->metadata();
  const DagAttributesView attributes =
      arguments.drop_attributes ? DagAttributesView{} : scene.file_->attributes();
  if (arguments.levels && *arguments.levels > dag.levels)
    throw Error(
        path, "",
        fmt::format("has {} levels, so that it cannot get {}", dag.levels, *arguments.levels));
  if (arguments.levels && *arguments.levels < dag.levels) {
    if (!attributes.is_empty())
      throw Error(path, "",
                  "has colours or normals, which a coarser grid cannot keep: use "
                  "--drop-attributes");
    scene.coarse_ = std::make_unique<Svdag>(
        coarsen(dag, *arguments.levels, scene.memory_.get(), &session.progress));
    dag = scene.coarse_->view();
    metadata = coarser_metadata(metadata, dag);
  }
  if (attributes.is_empty()) metadata.attributes = {};
  scene.bytes_ = make_scene_bytes(dag, metadata, attributes);
  return scene;
}

}  // namespace voxdag
