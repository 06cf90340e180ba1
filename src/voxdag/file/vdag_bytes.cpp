#include "voxdag/file/vdag_bytes.hpp"

#include <algorithm>
#include <cassert>
#include <cstring>

#include "voxdag/core/checked_size.hpp"
#include "voxdag/core/io/checksum.hpp"
#include "voxdag/file/vdag_format.hpp"

namespace voxdag {
namespace {

constexpr std::byte kZeros[kVdagAlignment] = {};

std::vector<ChunkSummary> summaries_of(const std::vector<OutputChunk>& chunks) {
  std::vector<ChunkSummary> summaries;
  for (const OutputChunk& chunk : chunks)
    summaries.push_back({chunk.id, chunk.flags, chunk.length(), chunk.checksum()});
  return summaries;
}

template <class T>
std::span<const std::byte> bytes_of(const T* values, std::size_t count) {
  return std::as_bytes(std::span<const T>(values, count));
}

std::vector<OutputChunk> plain_chunks(const std::string& json, const SvdagView& view,
                                      const std::uint64_t* level_begin,
                                      const AttributeChunks& attributes) {
  std::vector<OutputChunk> chunks = {
      required_chunk(kChunkMeta, bytes_of(json.data(), json.size())),
      required_chunk(kChunkLevels,
                     bytes_of(level_begin, static_cast<std::size_t>(view.levels - 1))),
      required_chunk(kChunkNodes, bytes_of(view.nodes, view.node_words())),
      required_chunk(kChunkLeafBlocks, bytes_of(view.leaf_blocks, view.leaf_block_count))};
  chunks.insert(chunks.end(), attributes.chunks().begin(), attributes.chunks().end());
  return chunks;
}

const std::uint64_t* copy_level_begin(const SvdagView& view, std::uint64_t* copy) {
  std::copy(std::begin(view.level_begin), std::end(view.level_begin), copy);
  return copy;
}

}  // namespace

std::vector<std::byte> vdag_head(std::span<const ChunkSummary> chunks) {
  const std::size_t table_end = sizeof(VdagHeader) + chunks.size() * sizeof(VdagChunkEntry);
  std::vector<std::byte> head(vdag_align(table_end));
  std::uint64_t offset = head.size();
  for (std::size_t i = 0; i < chunks.size(); ++i) {
    const VdagChunkEntry entry{chunks[i].id, chunks[i].flags, offset, chunks[i].length,
                               chunks[i].checksum};
    std::memcpy(head.data() + sizeof(VdagHeader) + i * sizeof entry, &entry, sizeof entry);
    offset += vdag_align(entry.length);
  }
  VdagHeader header{};
  std::memcpy(header.magic, kVdagMagic, sizeof kVdagMagic);
  header.version = kVdagVersion;
  header.chunk_count = static_cast<std::uint32_t>(chunks.size());
  header.file_bytes = offset;
  std::memcpy(head.data(), &header, sizeof header);
  header.checksum = xxh3_64({head.data(), table_end});
  std::memcpy(head.data(), &header, sizeof header);
  return head;
}

VdagBytes::VdagBytes(const std::vector<OutputChunk>& chunks)
    : head_(vdag_head(summaries_of(chunks))) {
  const auto add = [this](std::span<const std::byte> part) {
    if (!part.empty()) parts_.push_back(part);
    size_ += part.size();
  };
  add(head_);
  for (const OutputChunk& chunk : chunks) {
    for (const auto& part : chunk.parts) add(part);
    add({kZeros, checked_size(vdag_align(chunk.length()) - chunk.length())});
  }
}

PlainVdagBytes::PlainVdagBytes(const SvdagView& view, const VdagMetadata& metadata,
                               const DagAttributesView& attributes, AttributeForm form)
    : json_(checked_metadata_json(metadata)),
      attributes_(attributes, AttributeChunks::Index::kStored, form),
      bytes_(plain_chunks(json_, view, copy_level_begin(view, level_begin_), attributes_)) {
  assert(metadata.grid.levels == view.levels);
}

std::string checked_metadata_json(const VdagMetadata& metadata) {
  std::string json = vdag_metadata_json(metadata);
  if (json.size() > kVdagMaxMetadataBytes)
    throw Error("", ErrorPlace::chunk("META"),
                "would have " + std::to_string(json.size()) + " bytes, more than the limit of " +
                    std::to_string(kVdagMaxMetadataBytes) +
                    (metadata.attributes.materials ? ": the materials have too long names" : ""));
  parse_vdag_metadata(json);
  return json;
}

}  // namespace voxdag
