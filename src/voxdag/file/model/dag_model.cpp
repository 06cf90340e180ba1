#include "voxdag/file/model/dag_model.hpp"

#include <utility>

#include "voxdag/core/error.hpp"
#include "voxdag/core/with_file_name.hpp"
#include "voxdag/file/model/no_materials.hpp"
#include "voxdag/file/model/written_by.hpp"
#include "voxdag/file/vdag_writer.hpp"
#include "voxdag/file/wire_chunks.hpp"
#include "voxdag/stored/attributes/build_cell_index.hpp"
#include "voxdag/stored/attributes/material_colors.hpp"
#include "voxdag/stored/compact/encode_svdag.hpp"
#include "voxdag/stored/svdag/svdag_counts.hpp"

namespace voxdag {
namespace {

/// Returns the bytes that a .vdag file takes in memory before it is decoded.
std::uint64_t bytes_in_memory(const std::filesystem::path& path) {
  std::error_code unknown;  // Reading the file will tell the reason.
  const std::uintmax_t bytes = std::filesystem::file_size(path, unknown);
  return (unknown ? 0 : static_cast<std::uint64_t>(bytes)) + wire_bytes_of(path).expanded;
}

}  // namespace

DagModel::Decoded DagModel::decode(const std::filesystem::path& path, Progress* progress,
                                   MemoryBudget* memory) {
  Decoded decoded;
  const MemoryReservation file_bytes(memory, bytes_in_memory(path));
  CompactFile file(path);
  const CompactContents& contents = file.contents();
  with_file_name(path.string(), [&] {
    decoded.dag = decode_svdag(file.view(), memory, progress);
    if (contents.has_attributes()) {
      const MemoryReservation dag_bytes(memory, decoded.view().bytes());
      decoded.index =
          build_cell_index(decoded.view(), contents.metadata.attributes.level(), memory);
      decoded.stored = contents.attributes(decoded.index.view(), decoded.expanded);
    }
  });
  decoded.file = std::move(file);
  return decoded;
}

DagModel::DagModel(const std::filesystem::path& path, Progress* progress, MemoryBudget* memory)
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

DagModel::DagModel(Svdag dag, DagAttributes attributes, VdagMetadata metadata, MemoryBudget* memory)
    : dag_(Made{std::move(dag), std::move(attributes)}), metadata_(std::move(metadata)) {
  memory_ = MemoryReservation(memory, view().bytes() + std::get<Made>(dag_).stored.bytes());
  metadata_.counts = count_svdag(view());
  metadata_.program = written_by();
}

void DagModel::save(const std::filesystem::path& path, bool compact, Progress* progress,
                    MemoryBudget* memory) const {
  if (compact)
    write_vdag(path, encode_svdag(view(), {.memory = memory}, progress), metadata_, attributes());
  else
    write_vdag(path, view(), metadata_, attributes());
}

SvdagView DagModel::view() const {
  return std::visit([](const auto& dag) -> SvdagView { return dag.view(); }, dag_);
}

DagAttributesView DagModel::attributes() const {
  DagAttributesView view =
      std::visit([](const auto& dag) -> DagAttributesView { return dag.attributes(); }, dag_);
  if (material_colors_) view.colors = material_colors_->view();
  return view;
}

void DagModel::show_materials(const std::filesystem::path& path, Progress* progress) {
  if (!attributes().has_materials()) fail_without_materials(path);
  material_colors_ = material_colors(attributes().materials, progress);
}

}  // namespace voxdag
