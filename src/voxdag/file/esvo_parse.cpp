#include "voxdag/file/esvo_parse.hpp"

#include <string>

#include "voxdag/core/error.hpp"
#include "voxdag/file/vdag_format.hpp"
#include "voxdag/stored/esvo/validate_esvo.hpp"

namespace voxdag {

EsvoMetadata read_esvo_metadata(const std::vector<VdagChunk>& chunks) {
  return read_metadata_chunk(chunks, parse_esvo_metadata);
}

std::span<const EsvoBlockEntry> read_esvo_directory(const std::vector<VdagChunk>& chunks) {
  return chunk_values<EsvoBlockEntry>(chunks, kChunkEsvoBlocks);
}

std::uint64_t esvo_chunk_offset(const std::vector<VdagChunk>& chunks) {
  for (const VdagChunk& chunk : chunks)
    if (chunk.id == kChunkEsvo) return chunk.offset;
  throw Error("", "chunk table", "chunk ESVO is missing");
}

std::vector<VdagChunk> chunks_but_blocks(const std::vector<VdagChunk>& chunks) {
  std::vector<VdagChunk> others;
  for (const VdagChunk& chunk : chunks)
    if (chunk.id != kChunkEsvo) others.push_back(chunk);
  return others;
}

EsvoView read_esvo_view(const std::vector<VdagChunk>& chunks, const EsvoMetadata& metadata) {
  const auto slots = chunk_values<std::uint64_t>(chunks, kChunkEsvo);
  return {slots.data(), slots.size(), metadata.root, metadata.grid.levels};
}

void check_esvo_contents(const EsvoContents& contents) {
  EsvoCounts counts;
  try {
    counts = validate_esvo(contents.view, contents.directory);
  } catch (const Error& error) {
    throw error.within(ErrorPlace::chunk("ESVO"));
  }
  if (counts != contents.metadata.counts)
    throw Error("", ErrorPlace::chunk("META") / "counts", "differ from the octree's");
}

EsvoContents parse_esvo(std::span<const std::byte> file) {
  EsvoContents contents;
  contents.chunks = read_vdag_chunks(file);
  check_vdag_checksums(contents.chunks);
  contents.metadata = read_esvo_metadata(contents.chunks);
  contents.directory = read_esvo_directory(contents.chunks);
  contents.view = read_esvo_view(contents.chunks, contents.metadata);
  check_esvo_contents(contents);
  return contents;
}

}  // namespace voxdag
