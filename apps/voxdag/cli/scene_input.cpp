#include "cli/scene_input.hpp"

#include "voxdag/compact/encode_svdag.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/file/compact_file.hpp"

namespace voxdag {
namespace {

Svdag decode(const CompactFile& file, const std::filesystem::path& path, MemoryBudget* memory,
             Progress* progress) {
  try {
    return decode_svdag(file.view(), memory, progress);
  } catch (const Cancelled&) {
    throw;
  } catch (const OverMemory&) {
    throw;
  } catch (const Error& error) {
    throw error.in_file(path.string());
  }
}

std::variant<DagInput, EsvoFile> open(const std::filesystem::path& path, Progress* progress) {
  if (is_esvo_file(path)) return EsvoFile(path);
  return DagInput(path, progress);
}

}  // namespace

DagInput::DagInput(const std::filesystem::path& path, Progress* progress, MemoryBudget* memory)
    : dag_(Svdag()) {
  if (is_compact_file(path)) {
    const CompactFile file(path);
    memory_ = MemoryReservation(memory, file.file_bytes());
    dag_ = decode(file, path, memory, progress);
    metadata_ = file.metadata();
    file_bytes_ = file.file_bytes();
    memory_.resize(std::get<Svdag>(dag_).view().bytes());
  } else {
    VdagFile file(path);
    metadata_ = file.metadata();
    file_bytes_ = file.file_bytes();
    memory_ = MemoryReservation(memory, file_bytes_);
    dag_ = std::move(file);
  }
}

SvdagView DagInput::view() const {
  return std::visit([](const auto& dag) -> SvdagView { return dag.view(); }, dag_);
}

DagAttributesView DagInput::attributes() const {
  const VdagFile* const plain = std::get_if<VdagFile>(&dag_);
  return plain == nullptr ? DagAttributesView{} : plain->attributes();
}

SceneInput::SceneInput(const std::filesystem::path& path, Progress* progress)
    : scene_(open(path, progress)) {}

VoxelSet SceneInput::voxels() const {
  return std::visit([](const auto& file) { return VoxelSet(file.view()); }, scene_);
}

ColoredDagView SceneInput::colored_dag() const {
  const DagInput* const dag = std::get_if<DagInput>(&scene_);
  return dag == nullptr ? ColoredDagView{} : ColoredDagView{dag->view(), dag->attributes()};
}

const SceneMetadata& SceneInput::metadata() const {
  return std::visit([](const auto& file) -> const SceneMetadata& { return file.metadata(); },
                    scene_);
}

}  // namespace voxdag
