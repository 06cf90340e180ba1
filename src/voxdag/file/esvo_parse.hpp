#pragma once
/// Parses the bytes of an ESVO file, step by step. vdag_parse.hpp describes the container and the
/// rules for errors.
#include <span>
#include <vector>

#include "voxdag/file/esvo_metadata.hpp"
#include "voxdag/file/vdag_parse.hpp"
#include "voxdag/stored/esvo/esvo.hpp"
#include "voxdag/stored/esvo/esvo_directory.hpp"

namespace voxdag {

struct EsvoContents {
  std::vector<VdagChunk> chunks;
  EsvoMetadata metadata;
  std::span<const EsvoBlockEntry> directory;  ///< Points into the bytes, as does the view.
  EsvoView view;
};

EsvoMetadata read_esvo_metadata(const std::vector<VdagChunk>& chunks);
std::span<const EsvoBlockEntry> read_esvo_directory(const std::vector<VdagChunk>& chunks);
/// Returns the offset of the blocks in the file, in bytes.
std::uint64_t esvo_chunk_offset(const std::vector<VdagChunk>& chunks);
/// Returns all chunks but ESVO, whose blocks have checksums of their own.
std::vector<VdagChunk> chunks_but_blocks(const std::vector<VdagChunk>& chunks);
/// Returns a view of the slots, without checking them.
EsvoView read_esvo_view(const std::vector<VdagChunk>& chunks, const EsvoMetadata& metadata);
/// Runs validate_esvo and compares the counts with those of `metadata`. Errors name the chunk.
void check_esvo_contents(const EsvoContents& contents);

/// Runs all steps. The result is safe to walk.
EsvoContents parse_esvo(std::span<const std::byte> file);

}  // namespace voxdag
