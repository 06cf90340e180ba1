#include "voxdag/file/model/dag_model.hpp"

#include <utility>

#include "voxdag/core/error.hpp"
#include "voxdag/core/printable.hpp"
#include "voxdag/core/with_file_name.hpp"
#include "voxdag/file/model/no_materials.hpp"
#include "voxdag/file/model/written_by.hpp"
#include "voxdag/file/vdag_writer.hpp"
#include "voxdag/file/wire_chunks.hpp"
#include "voxdag/stored/attributes/build_cell_index.hpp"
#include "voxdag/stored/attributes/channel_colors.hpp"
#include "voxdag/stored/attributes/material_colors.hpp"
#include "voxdag/stored/compact/encode_svdag.hpp"
#include "voxdag/stored/svdag/svdag_counts.hpp"

namespace voxdag {

DagModel::Decoded DagModel::decode(CompactFile file, const std::string& path, Work work) {
  Decoded decoded;
  const CompactContents& contents = file.contents();
  with_file_name(path, [&] {
    decoded.dag = decode_svdag(file.view(), work);
    if (contents.has_attributes()) {
      const MemoryReservation dag_bytes(work.memory, decoded.view().bytes());
      decoded.index =
          build_cell_index(decoded.view(), contents.metadata.attributes.level(), work.memory);
      decoded.stored = contents.attributes(decoded.index.view(), decoded.expanded);
    }
  });
  if (contents.has_attributes()) decoded.file = std::move(file);
  return decoded;
}

DagModel::DagModel(VdagContainer file, Work work)
    : dag_(Decoded()), file_bytes_(file.bytes().size()) {
  const bool is_compact = file.kind() == VdagKind::kCompact;
  const std::uint64_t expanded_bytes = wire_bytes_of(file).expanded;
  memory_ = MemoryReservation(work.memory, expanded_bytes);
  if (!is_compact) {
    VdagFile plain(std::move(file));
    metadata_ = plain.metadata();
    dag_ = std::move(plain);
    return;
  }
  const std::string path = file.path().string();
  CompactFile compact(std::move(file));
  metadata_ = compact.metadata();
  Decoded decoded = decode(std::move(compact), path, work);
  memory_ = {};
  memory_ = MemoryReservation(
      work.memory, decoded.view().bytes() + decoded.index.view().bytes() + expanded_bytes);
  dag_ = std::move(decoded);
}

DagModel::DagModel(Svdag dag, DagAttributes attributes, VdagMetadata metadata, Work work)
    : dag_(Made{std::move(dag), std::move(attributes)}), metadata_(std::move(metadata)) {
  memory_ = MemoryReservation(work.memory, view().bytes() + std::get<Made>(dag_).stored.bytes());
  metadata_.counts = count_svdag(view());
  metadata_.program = written_by();
}

void DagModel::save(const std::filesystem::path& path, bool compact, Work work) const {
  if (compact)
    write_vdag(path, encode_svdag(view(), {}, work), metadata_, attributes());
  else
    write_vdag(path, view(), metadata_, attributes());
}

SvdagView DagModel::view() const {
  return std::visit([](const auto& dag) -> SvdagView { return dag.view(); }, dag_);
}

DagAttributesView DagModel::attributes() const {
  DagAttributesView view =
      std::visit([](const auto& dag) -> DagAttributesView { return dag.attributes(); }, dag_);
  if (shown_colors_) view.colors = shown_colors_->view();
  return view;
}

void DagModel::show_materials(const std::filesystem::path& path, Work work) {
  if (!attributes().has_materials()) fail_without_materials(path);
  shown_colors_ = material_colors(attributes().materials, work);
}

ChannelRange DagModel::show_channel(const std::filesystem::path& path, const std::string& name,
                                    const std::optional<ChannelRange>& range, Work work) {
  const ChannelsView channels = attributes().channels;
  const std::size_t i = channels.find(name);
  if (i == channels.count()) {
    std::string names;
    for (std::size_t k = 0; k < channels.count(); ++k)
      names += (k > 0 ? ", " : "") + std::string(channels[k].name());
    throw Error(path.string(), "",
                "has no channel " + in_quotes(name) +
                    (names.empty() ? ": voxdag import --channel stores some"
                                   : ": its channels are " + names));
  }
  const ChannelRange used = range.value_or(range_of(channels[i]));
  shown_colors_ = channel_colors(channels[i], used, work);
  return used;
}

}  // namespace voxdag
