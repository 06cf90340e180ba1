#pragma once
/// The bytes of a .vdag file that holds a DAG in the plain form, without a copy of the DAG.
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "voxdag/file/attribute_chunks.hpp"
#include "voxdag/file/output_chunk.hpp"
#include "voxdag/file/vdag_metadata.hpp"
#include "voxdag/stored/attributes/stored_attributes.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

/// An entry of the chunk table, without the chunk's offset.
struct ChunkSummary {
  std::uint32_t id = 0;
  std::uint32_t flags = 0;  ///< See VdagChunkEntry.
  std::uint64_t length = 0, checksum = 0;
};

/// Returns the bytes before the first chunk: header and chunk table, padded. The chunks follow,
/// each padded to a multiple of kVdagAlignment.
std::vector<std::byte> vdag_head(std::span<const ChunkSummary> chunks);

/// The parts of a file with these chunks. Refers to the chunks' bytes and owns the rest.
class VdagBytes {
 public:
  explicit VdagBytes(const std::vector<OutputChunk>& chunks);
  VdagBytes(const VdagBytes&) = delete;
  VdagBytes& operator=(const VdagBytes&) = delete;

  /// Returns the parts, which follow each other in the file.
  const std::vector<std::span<const std::byte>>& parts() const { return parts_; }
  /// Returns the size of the file.
  std::uint64_t size() const { return size_; }

 private:
  std::vector<std::byte> head_;
  std::vector<std::span<const std::byte>> parts_;
  std::uint64_t size_ = 0;
};

/// The bytes of the file that write_vdag() writes for these arguments, which must outlive it.
class PlainVdagBytes {
 public:
  /// Throws Error as write_vdag() does, without a file name. Reads the DAG once, for its checksums.
  PlainVdagBytes(const SvdagView& view, const VdagMetadata& metadata,
                 const DagAttributesView& attributes = {},
                 AttributeForm form = AttributeForm::kPages);

  const std::vector<std::span<const std::byte>>& parts() const { return bytes_.parts(); }
  std::uint64_t size() const { return bytes_.size(); }

 private:
  std::string json_;
  std::uint64_t level_begin_[kMaxLevels + 1];
  AttributeChunks attributes_;
  VdagBytes bytes_;
};

/// Returns the JSON of META. Throws Error, without a file name, if a reader would refuse it.
std::string checked_metadata_json(const VdagMetadata& metadata);

}  // namespace voxdag
