#include "voxdag/file/vdag_writer.hpp"

#include <cassert>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "voxdag/core/error.hpp"
#include "voxdag/file/attribute_chunks.hpp"
#include "voxdag/file/output_chunk.hpp"
#include "voxdag/file/vdag_format.hpp"
#include "voxdag/file/verify_vdag.hpp"
#include "voxdag/io/atomic_file.hpp"
#include "voxdag/io/checksum.hpp"
#include "voxdag/layout/compact/compact_bytes.hpp"

namespace voxdag {
namespace {

template <class T>
std::span<const std::byte> bytes_of(const T* values, std::size_t count) {
  return std::as_bytes(std::span<const T>(values, count));
}

/// Returns the bytes before the first chunk: header and table with checksums, padded.
std::vector<std::byte> make_head(const std::vector<OutputChunk>& chunks) {
  const std::size_t table_end = sizeof(VdagHeader) + chunks.size() * sizeof(VdagChunkEntry);
  std::vector<std::byte> head(vdag_align(table_end));
  std::uint64_t offset = head.size();
  for (std::size_t i = 0; i < chunks.size(); ++i) {
    const VdagChunkEntry entry{chunks[i].id, chunks[i].flags, offset, chunks[i].length(),
                               chunks[i].checksum()};
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

void write_chunks(const std::filesystem::path& path, const std::vector<OutputChunk>& chunks) {
  AtomicFile file(path);
  file.write(std::span<const std::byte>(make_head(chunks)));
  for (const OutputChunk& chunk : chunks) {
    for (const auto& part : chunk.parts) file.write(part);
    file.write_zeros(vdag_align(chunk.length()) - chunk.length());
  }
  file.commit();
}

/// Returns the JSON of META. Throws Error for the path if a reader would refuse it.
std::string checked_json(const std::filesystem::path& path, const VdagMetadata& metadata) {
  std::string json = vdag_metadata_json(metadata);
  if (json.size() > kVdagMostMetadataBytes)
    throw Error(path.string(), ErrorPlace::chunk("META"),
                "would have " + std::to_string(json.size()) + " bytes, more than the limit of " +
                    std::to_string(kVdagMostMetadataBytes) +
                    (metadata.attributes.materials ? ": the materials have too long names" : ""));
  try {
    parse_vdag_metadata(json);
  } catch (const Error& error) {
    throw error.in_file(path.string());
  }
  return json;
}

/// Throws Error for the path unless the metadata describes these attributes.
void check_attributes_metadata(const std::filesystem::path& path, const VdagMetadata& metadata,
                               const DagAttributesView& attributes) {
  try {
    compare_attributes(metadata.attributes, attributes);
  } catch (const Error& error) {
    throw error.in_file(path.string());
  }
}

/// Returns a required chunk.
OutputChunk required(std::uint32_t id, std::span<const std::byte> bytes) {
  return {id, kVdagChunkRequired, {bytes}};
}

}  // namespace

void write_vdag(const std::filesystem::path& path, const SvdagView& view,
                const VdagMetadata& metadata, const DagAttributesView& attributes) {
  assert(metadata.grid.levels == view.levels);
  const std::string json = checked_json(path, metadata);
  std::vector<OutputChunk> chunks = {
      required(kChunkMeta, bytes_of(json.data(), json.size())),
      required(kChunkLevels, bytes_of(view.level_begin, static_cast<std::size_t>(view.levels - 1))),
      required(kChunkNodes, bytes_of(view.nodes, view.node_words())),
      required(kChunkLeafBlocks, bytes_of(view.leaf_blocks, view.leaf_block_count))};
  const AttributeChunks attribute_chunks(attributes, AttributeChunks::Index::kStored);
  chunks.insert(chunks.end(), attribute_chunks.chunks().begin(), attribute_chunks.chunks().end());
  write_chunks(path, chunks);
}

void write_vdag(const std::filesystem::path& path, const CompactSvdag& compact,
                const VdagMetadata& metadata, const DagAttributesView& attributes) {
  assert(metadata.grid.levels == compact.levels);
  const std::string json = checked_json(path, metadata);
  // A reader numbers the cells down to the level that the metadata has.
  if (!attributes.is_empty()) check_attributes_metadata(path, metadata, attributes);
  const std::vector<std::byte> head = compact_head(compact);
  std::vector<OutputChunk> chunks = {required(kChunkMeta, bytes_of(json.data(), json.size())),
                                     required(kChunkCompactHead, head),
                                     required(kChunkCompactStream, std::as_bytes(compact.words()))};
  const AttributeChunks attribute_chunks(attributes, AttributeChunks::Index::kLeftOut);
  chunks.insert(chunks.end(), attribute_chunks.chunks().begin(), attribute_chunks.chunks().end());
  write_chunks(path, chunks);
}

}  // namespace voxdag
