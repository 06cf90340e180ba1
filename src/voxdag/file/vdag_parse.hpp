#pragma once
/// Reading the bytes of a .vdag file, each step by itself. Errors have no file name; their place is
/// "header", "chunk table", "chunk NODE, level 3, word 17" or "byte 192". No step reads outside the
/// bytes given, whatever they are.
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "voxdag/core/error.hpp"
#include "voxdag/file/vdag_metadata.hpp"
#include "voxdag/layout/svdag.hpp"

namespace voxdag {

struct VdagChunk {
  std::uint32_t id = 0;
  bool required = false;
  std::uint64_t offset = 0;    ///< In the file.
  std::uint64_t checksum = 0;  ///< As the table says.
  std::span<const std::byte> bytes;
};

struct VdagContents {
  std::vector<VdagChunk> chunks;
  VdagMetadata metadata;
  SvdagView view;  ///< Points into the bytes that were parsed.
};

/// Header and chunk table: magic, version, size, table checksum, every chunk where it must be, none
/// twice, no required one unknown, the padding zero, nothing behind. Does not look into chunks.
/// `file` must be aligned to 8 bytes or more.
std::vector<VdagChunk> read_vdag_chunks(std::span<const std::byte> file);

/// Throws where the bytes do not have the checksum of the table.
void check_vdag_checksums(const std::vector<VdagChunk>& chunks);

/// The chunk's bytes; throws where it is missing or its length is no multiple of `multiple`.
std::span<const std::byte> chunk_bytes(const std::vector<VdagChunk>& chunks, std::uint32_t id,
                                       std::size_t multiple);
/// The JSON of META.
std::string_view metadata_chunk_text(const std::vector<VdagChunk>& chunks);

VdagMetadata read_vdag_metadata(const std::vector<VdagChunk>& chunks);

/// What `parse` makes of the text of META, with the chunk named in its errors.
template <class Parse>
auto read_metadata_chunk(const std::vector<VdagChunk>& chunks, const Parse& parse) {
  const std::string_view text = metadata_chunk_text(chunks);
  try {
    return parse(text);
  } catch (const Error& error) {
    throw error.within(ErrorPlace::chunk("META"));
  }
}

/// The chunk as values; throws where it is missing or its length is no multiple of theirs.
template <class T>
std::span<const T> chunk_values(const std::vector<VdagChunk>& chunks, std::uint32_t id) {
  const std::span<const std::byte> bytes = chunk_bytes(chunks, id, sizeof(T));
  return {reinterpret_cast<const T*>(bytes.data()), bytes.size() / sizeof(T)};
}

/// The DAG of LEVL, NODE and LEAF for a grid of `levels`; lengths are checked, contents are not.
SvdagView read_vdag_svdag(const std::vector<VdagChunk>& chunks, int levels);

/// validate_svdag, check_canonical or check_minimal, with the chunk named in the error.
void check_vdag_svdag(const SvdagView& view, void (*check)(const SvdagView&));

/// All the steps and validate_svdag: what it returns is safe to walk.
VdagContents parse_vdag(std::span<const std::byte> file);

}  // namespace voxdag
