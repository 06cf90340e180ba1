#pragma once
/// Reading the bytes of an ESVO file, each step by itself; see vdag_parse.hpp, whose container it
/// is in and whose rules for errors hold here too.
#include <span>
#include <vector>

#include "voxdag/file/esvo_metadata.hpp"
#include "voxdag/file/vdag_parse.hpp"
#include "voxdag/layout/esvo.hpp"
#include "voxdag/layout/esvo_directory.hpp"

namespace voxdag {

/// Whether these are the chunks of an ESVO: those of other files have no ESVO chunk.
bool is_esvo(const std::vector<VdagChunk>& chunks);

struct EsvoContents {
  std::vector<VdagChunk> chunks;
  EsvoMetadata metadata;
  std::span<const EsvoBlockEntry> directory;  ///< Points into the bytes, as does the view.
  EsvoView view;
};

EsvoMetadata read_esvo_metadata(const std::vector<VdagChunk>& chunks);
std::span<const EsvoBlockEntry> read_esvo_directory(const std::vector<VdagChunk>& chunks);
/// Where the blocks begin in the file.
std::uint64_t esvo_chunk_offset(const std::vector<VdagChunk>& chunks);
/// All but the blocks themselves, which have checksums of their own.
std::vector<VdagChunk> chunks_but_blocks(const std::vector<VdagChunk>& chunks);
/// Contents are not checked.
EsvoView read_esvo_view(const std::vector<VdagChunk>& chunks, const EsvoMetadata& metadata);
/// validate_esvo, with the chunk named in the error, and the counts against those of `metadata`.
void check_esvo_contents(const EsvoContents& contents);

/// All the steps: what it returns is safe to walk.
EsvoContents parse_esvo(std::span<const std::byte> file);

}  // namespace voxdag
