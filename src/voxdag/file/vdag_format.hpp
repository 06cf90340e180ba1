#pragma once
/// The bytes of a .vdag file; docs/format.md is the specification.
///
///   0    VdagHeader             64 bytes
///   64   VdagChunkEntry[count]  32 bytes each
///        zeros up to the next multiple of 64
///   ...  chunk 0, zeros up to the next multiple of 64
///   ...  chunk 1, ...
///
/// Everything is little-endian. Chunks are stored in the table's order, with only padding between
/// them. The file ends with the padding of the last chunk.
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>

namespace voxdag {

static_assert(
    std::endian::native == std::endian::little,
    "the bytes of a file are used as they are: a big-endian host needs a converting reader");

inline constexpr unsigned char kVdagMagic[8] = {0x89, 'V', 'D', 'A', 'G', '\r', '\n', 0x1A};
inline constexpr std::uint32_t kVdagVersion = 1;
inline constexpr std::uint64_t kVdagAlignment = 64;
inline constexpr std::uint32_t kVdagMaxChunks = 1024;
inline constexpr std::uint64_t kVdagMaxMetadataBytes = std::uint64_t{1} << 20;

struct VdagHeader {
  unsigned char magic[8];
  std::uint32_t version;
  std::uint32_t chunk_count;
  std::uint64_t file_bytes;   ///< Size of the whole file, padding included.
  std::uint64_t checksum;     ///< XXH3-64 of header and table, with this field taken as zero.
  std::uint64_t reserved[4];  ///< Zero.
};
static_assert(sizeof(VdagHeader) == 64 && offsetof(VdagHeader, checksum) == 24);

struct VdagChunkEntry {
  std::uint32_t id;        ///< Four ASCII characters, the first in the lowest byte.
  std::uint32_t flags;     ///< kVdagChunkRequired or 0.
  std::uint64_t offset;    ///< From the start of the file; a multiple of 64.
  std::uint64_t length;    ///< Without the padding.
  std::uint64_t checksum;  ///< XXH3-64 of the `length` bytes.
};
static_assert(sizeof(VdagChunkEntry) == 32 && offsetof(VdagChunkEntry, checksum) == 24);

/// A reader must refuse a file with an unknown chunk that has this flag. It skips unknown chunks
/// without the flag.
inline constexpr std::uint32_t kVdagChunkRequired = 1;

constexpr std::uint32_t vdag_chunk_id(const char (&name)[5]) {
  std::uint32_t id = 0;
  for (int i = 0; i < 4; ++i) id |= std::uint32_t{static_cast<unsigned char>(name[i])} << 8 * i;
  return id;
}
inline constexpr std::uint32_t kChunkMeta =
    vdag_chunk_id("META");  ///< JSON, see vdag_metadata.hpp.
inline constexpr std::uint32_t kChunkLevels = vdag_chunk_id("LEVL");  ///< u64 level_begin[0..L-2].
inline constexpr std::uint32_t kChunkNodes = vdag_chunk_id("NODE");   ///< u32 SvdagView::nodes.
inline constexpr std::uint32_t kChunkLongNodes =
    vdag_chunk_id("NODX");  ///< u32 LongSvdagView::nodes; instead of NODE.
inline constexpr std::uint32_t kChunkLeafBlocks = vdag_chunk_id("LEAF");  ///< u64 leaf_blocks.
inline constexpr std::uint32_t kChunkCompactHead =
    vdag_chunk_id("CHED");  ///< See stored/compact/compact_bytes.hpp.
inline constexpr std::uint32_t kChunkCompactStream =
    vdag_chunk_id("CSTR");                                          ///< u32 CompactSvdag::stream.
inline constexpr std::uint32_t kChunkEsvo = vdag_chunk_id("ESVO");  ///< u64 slots of all blocks.
inline constexpr std::uint32_t kChunkEsvoBlocks =
    vdag_chunk_id("EBLK");  ///< EsvoBlockEntry of each block.
// These chunks are not required: a reader that ignores attributes can use the rest of the file.
inline constexpr std::uint32_t kChunkCellIndex = vdag_chunk_id("CIDX");    ///< attribute_chunks.hpp
inline constexpr std::uint32_t kChunkColors = vdag_chunk_id("COLR");       ///< attribute_chunks.hpp
inline constexpr std::uint32_t kChunkNormals = vdag_chunk_id("NRML");      ///< attribute_chunks.hpp
inline constexpr std::uint32_t kChunkMaterials = vdag_chunk_id("MTID");    ///< attribute_chunks.hpp
inline constexpr std::uint32_t kChunkChannels = vdag_chunk_id("CHAN");     ///< attribute_chunks.hpp
inline constexpr std::uint32_t kChunkWireColors = vdag_chunk_id("WCOL");   ///< wire_chunks.hpp
inline constexpr std::uint32_t kChunkWireNormals = vdag_chunk_id("WNRM");  ///< wire_chunks.hpp
inline constexpr std::uint32_t kChunkWireMaterials = vdag_chunk_id("WMTI");  ///< wire_chunks.hpp

/// Returns the id as text, such as "NODE", with "?" for bytes other than letters, digits and
/// spaces.
inline std::string vdag_chunk_name(std::uint32_t id) {
  std::string name;
  for (int i = 0; i < 4; ++i) {
    const char c = static_cast<char>(id >> 8 * i & 0xFF);
    const bool plain =
        (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == ' ';
    name += plain ? c : '?';
  }
  return name;
}

constexpr std::uint64_t vdag_align(std::uint64_t bytes) {
  return (bytes + kVdagAlignment - 1) / kVdagAlignment * kVdagAlignment;
}

}  // namespace voxdag
