#include "voxdag/file/vdag_writer.hpp"

#include <cassert>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/atomic_file.hpp"
#include "voxdag/core/with_file_name.hpp"
#include "voxdag/file/attribute_chunks.hpp"
#include "voxdag/file/output_chunk.hpp"
#include "voxdag/file/vdag_bytes.hpp"
#include "voxdag/file/vdag_format.hpp"
#include "voxdag/file/verify_vdag.hpp"
#include "voxdag/stored/compact/compact_bytes.hpp"

namespace voxdag {
namespace {

void write_parts(const std::filesystem::path& path,
                 const std::vector<std::span<const std::byte>>& parts) {
  AtomicFile file(path);
  for (const auto& part : parts) file.write(part);
  file.commit();
}

}  // namespace

void write_vdag(const std::filesystem::path& path, const SvdagView& view,
                const VdagMetadata& metadata, const DagAttributesView& attributes,
                AttributeForm form) {
  const auto bytes = with_file_name(path.string(), [&] {
    return std::make_unique<PlainVdagBytes>(view, metadata, attributes, form);
  });
  write_parts(path, bytes->parts());
}

void write_vdag(const std::filesystem::path& path, const CompactSvdag& compact,
                const VdagMetadata& metadata, const DagAttributesView& attributes,
                AttributeForm form) {
  assert(metadata.grid.levels == compact.levels);
  const std::string json = with_file_name(path.string(), [&] {
    // A reader numbers the cells down to the level that the metadata has.
    if (!attributes.is_empty()) compare_attributes(metadata.attributes, attributes);
    return checked_metadata_json(metadata);
  });
  const std::vector<std::byte> head = compact_head(compact);
  std::vector<OutputChunk> chunks = {
      required_chunk(kChunkMeta, std::as_bytes(std::span<const char>(json))),
      required_chunk(kChunkCompactHead, head),
      required_chunk(kChunkCompactStream, std::as_bytes(compact.words()))};
  const AttributeChunks attribute_chunks(attributes, AttributeChunks::Index::kLeftOut, form);
  chunks.insert(chunks.end(), attribute_chunks.chunks().begin(), attribute_chunks.chunks().end());
  write_parts(path, VdagBytes(chunks).parts());
}

}  // namespace voxdag
