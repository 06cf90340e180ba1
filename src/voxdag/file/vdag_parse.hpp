#pragma once
/// Parses the bytes of a .vdag file, step by step. Errors have no file name; their place is
/// "header", "chunk table", "chunk NODE, level 3, word 17" or "byte 192". No step reads outside of
/// the given bytes, whatever they contain.
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "voxdag/core/error.hpp"
#include "voxdag/file/vdag_metadata.hpp"
#include "voxdag/stored/attributes/stored_attributes.hpp"
#include "voxdag/stored/svdag/long_svdag.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

struct VdagChunk {
  std::uint32_t id = 0;
  bool required = false;
  std::uint64_t offset = 0;    ///< Byte in the file.
  std::uint64_t checksum = 0;  ///< From the chunk table.
  std::span<const std::byte> bytes;
};

/// The memory of the chunks that expand_wire_chunks() made. Move-only: the chunks point into it.
using ExpandedChunks = std::vector<std::unique_ptr<std::uint64_t[]>>;

struct VdagContents {
  std::vector<VdagChunk> chunks;  ///< Without the wire form: see expand_wire_chunks().
  ExpandedChunks expanded;
  VdagMetadata metadata;
  // Views of the bytes that were parsed, and of `expanded`.
  SvdagView view;
  DagAttributesView attributes;  ///< Empty if the file has none.
};

/// Reads header and chunk table. Checks magic, version, size and table checksum. Checks that every
/// chunk has the right offset, that ids are unique, that no unknown chunk is required, and that the
/// padding is zero. Does not read the contents of chunks. `file` must be aligned to 8 bytes or
/// more.
std::vector<VdagChunk> read_vdag_chunks(std::span<const std::byte> file);

/// Returns the chunk; null if the file has none with this id.
const VdagChunk* find_chunk(const std::vector<VdagChunk>& chunks, std::uint32_t id);

inline bool has_chunk(const std::vector<VdagChunk>& chunks, std::uint32_t id) {
  return find_chunk(chunks, id) != nullptr;
}

/// Throws Error if the checksum of a chunk's bytes differs from the one in the table.
void check_vdag_checksums(const std::vector<VdagChunk>& chunks);

/// Returns the chunk's bytes. Throws Error if it is missing, or if its length is not a multiple of
/// `multiple`.
std::span<const std::byte> chunk_bytes(const std::vector<VdagChunk>& chunks, std::uint32_t id,
                                       std::size_t multiple);
/// Returns the JSON of META.
std::string_view metadata_chunk_text(const std::vector<VdagChunk>& chunks);

VdagMetadata read_vdag_metadata(const std::vector<VdagChunk>& chunks);

/// Returns parse(text), where text is the JSON of META. Errors name the chunk.
template <class Parse>
auto read_metadata_chunk(const std::vector<VdagChunk>& chunks, const Parse& parse) {
  const std::string_view text = metadata_chunk_text(chunks);
  try {
    return parse(text);
  } catch (const Error& error) {
    throw error.within(ErrorPlace::chunk("META"));
  }
}

/// Returns the chunk as an array of T. Throws Error if it is missing, or if its length is not a
/// multiple of sizeof(T).
template <class T>
std::span<const T> chunk_values(const std::vector<VdagChunk>& chunks, std::uint32_t id) {
  const std::span<const std::byte> bytes = chunk_bytes(chunks, id, sizeof(T));
  return {reinterpret_cast<const T*>(bytes.data()), bytes.size() / sizeof(T)};
}

/// Returns the DAG of LEVL, NODE and LEAF for a grid of `levels`. Checks lengths, but not contents.
/// Throws Error, also if the file has NODX.
SvdagView read_vdag_svdag(const std::vector<VdagChunk>& chunks, int levels);
/// Returns the DAG of LEVL, NODX and LEAF in the same way. Throws Error also if the file has NODE
/// or attributes.
LongSvdagView read_vdag_long_svdag(const std::vector<VdagChunk>& chunks, int levels);

/// Runs validate_svdag, check_canonical or check_minimal. Errors name the chunk.
void check_vdag_svdag(const SvdagView& view, void (*check)(const SvdagView&));
void check_vdag_svdag(const LongSvdagView& view, void (*check)(const LongSvdagView&));

/// Runs all steps, validate_svdag() and the checks of attributes. The result is safe to walk.
VdagContents parse_vdag(std::span<const std::byte> file);

}  // namespace voxdag
