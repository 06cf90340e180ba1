#include "cli/scene_input.hpp"

#include "voxdag/attributes/material_colors.hpp"
#include "voxdag/compact/encode_svdag.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/file/wire_chunks.hpp"
#include "voxdag/layout/build_cell_index.hpp"

namespace voxdag {
namespace {

std::variant<DagInput, EsvoFile> open(const std::filesystem::path& path, Progress* progress) {
  if (is_esvo_file(path)) return EsvoFile(path);
  return DagInput(path, progress);
}

[[noreturn]] void fail_without_materials(const std::filesystem::path& path) {
  throw Error(path.string(), "", "has no material ids: voxdag build --material-ids stores them");
}

/// Returns the bytes that a .vdag file takes in memory before it is decoded.
std::uint64_t bytes_in_memory(const std::filesystem::path& path) {
  std::error_code unknown;  // Reading the file will tell the reason.
  const std::uintmax_t bytes = std::filesystem::file_size(path, unknown);
  return (unknown ? 0 : static_cast<std::uint64_t>(bytes)) + wire_bytes_of(path).expanded;
}

}  // namespace

DagInput::Decoded DagInput::decode(const std::filesystem::path& path, Progress* progress,
                                   MemoryBudget* memory) {
  Decoded decoded;
  const MemoryReservation file_bytes(memory, bytes_in_memory(path));
  CompactFile file(path);
  const CompactContents& contents = file.contents();
  try {
    decoded.dag = decode_svdag(file.view(), memory, progress);
    if (contents.has_attributes()) {
      const MemoryReservation dag_bytes(memory, decoded.view().bytes());
      decoded.index =
          build_cell_index(decoded.view(), contents.metadata.attributes.level(), memory);
      decoded.stored = contents.attributes(decoded.index.view(), decoded.expanded);
    }
  } catch (const Cancelled&) {
    throw;
  } catch (const OverMemory&) {
    throw;
  } catch (const Error& error) {
    throw error.in_file(path.string());
  }
  decoded.file = std::move(file);
  return decoded;
}

DagInput::DagInput(const std::filesystem::path& path, Progress* progress, MemoryBudget* memory)
    : dag_(Decoded()) {
  if (is_compact_file(path)) {
    Decoded decoded = decode(path, progress, memory);
    metadata_ = decoded.file->metadata();
    file_bytes_ = decoded.file->file_bytes();
    const bool is_kept = decoded.file->contents().has_attributes();
    if (!is_kept) decoded.file.reset();
    memory_ = MemoryReservation(memory, decoded.view().bytes() + decoded.index.view().bytes() +
                                            (is_kept ? bytes_in_memory(path) : 0));
    dag_ = std::move(decoded);
  } else {
    memory_ = MemoryReservation(memory, bytes_in_memory(path));
    VdagFile file(path);
    metadata_ = file.metadata();
    file_bytes_ = file.file_bytes();
    dag_ = std::move(file);
  }
}

SvdagView DagInput::view() const {
  return std::visit([](const auto& dag) -> SvdagView { return dag.view(); }, dag_);
}

DagAttributesView DagInput::attributes() const {
  DagAttributesView view =
      std::visit([](const auto& dag) -> DagAttributesView { return dag.attributes(); }, dag_);
  if (material_colors_) view.colors = material_colors_->view();
  return view;
}

void DagInput::show_materials(const std::filesystem::path& path, Progress* progress) {
  if (!attributes().has_materials()) fail_without_materials(path);
  material_colors_ = material_colors(attributes().materials, progress);
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

void SceneInput::show_materials(const std::filesystem::path& path, Progress* progress) {
  DagInput* const dag = std::get_if<DagInput>(&scene_);
  if (dag == nullptr) fail_without_materials(path);
  dag->show_materials(path, progress);
}

const SceneMetadata& SceneInput::metadata() const {
  return std::visit([](const auto& file) -> const SceneMetadata& { return file.metadata(); },
                    scene_);
}

}  // namespace voxdag
