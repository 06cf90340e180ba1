#include "voxdag/file/vdag_parse.hpp"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <iterator>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/checksum.hpp"
#include "voxdag/file/attribute_chunks.hpp"
#include "voxdag/file/vdag_format.hpp"
#include "voxdag/file/wire_chunks.hpp"
#include "voxdag/stored/svdag/validate_svdag.hpp"

namespace voxdag {
namespace {

ErrorPlace chunk_place(std::uint32_t id) { return ErrorPlace::chunk(vdag_chunk_name(id)); }

ErrorPlace table_place(std::uint32_t id) { return ErrorPlace("chunk table") / chunk_place(id); }

VdagHeader read_header(std::span<const std::byte> file) {
  VdagHeader header;
  const std::size_t magic_bytes = std::min(file.size(), sizeof header.magic);
  if (file.empty()) fail_at("", "empty file");
  if (std::memcmp(file.data(), kVdagMagic, magic_bytes) != 0) fail_at("header", "not a .vdag file");
  if (file.size() < sizeof header)
    fail_at(ErrorPlace::byte(file.size()), "truncated: the file ends inside its header");
  std::memcpy(&header, file.data(), sizeof header);
  // The version is checked first: the meaning of the rest depends on it.
  if (header.version > kVdagVersion)
    fail_at("header", "version " + std::to_string(header.version) +
                          " is newer than this program's version " + std::to_string(kVdagVersion));
  if (header.version != kVdagVersion)
    fail_at("header", "version " + std::to_string(header.version) + " does not exist");
  if (header.file_bytes > file.size())
    fail_at(ErrorPlace::byte(file.size()),
            "truncated: the header says " + std::to_string(header.file_bytes) + " bytes");
  if (header.file_bytes < file.size())
    fail_at(ErrorPlace::byte(header.file_bytes),
            "has " + std::to_string(file.size() - header.file_bytes) + " trailing bytes");
  if (header.chunk_count > kVdagMaxChunks ||
      header.chunk_count > (file.size() - sizeof header) / sizeof(VdagChunkEntry))
    fail_at("header", std::to_string(header.chunk_count) + " chunks do not fit into the file");
  return header;
}

void check_header_checksum(std::span<const std::byte> file, std::size_t table_end,
                           std::uint64_t expected) {
  std::vector<std::byte> copy(file.begin(),
                              std::next(file.begin(), static_cast<std::ptrdiff_t>(table_end)));
  std::memset(copy.data() + offsetof(VdagHeader, checksum), 0, sizeof expected);
  if (xxh3_64(copy) != expected)
    fail_at("header", "checksum of the header and chunk table is wrong");
  for (std::size_t i = offsetof(VdagHeader, reserved); i < sizeof(VdagHeader); ++i)
    if (file[i] != std::byte{0}) fail_at(ErrorPlace::byte(i), "reserved byte is not zero");
}

void check_padding(std::span<const std::byte> file, std::uint64_t begin, std::uint64_t end) {
  for (std::uint64_t i = begin; i < end; ++i)
    if (file[i] != std::byte{0}) fail_at(ErrorPlace::byte(i), "padding is not zero");
}

/// Checks a row of the chunk table; its chunk must start at `expected_offset`.
VdagChunk read_entry(std::span<const std::byte> file, const VdagChunkEntry& entry,
                     std::uint64_t expected_offset) {
  const ErrorPlace place = table_place(entry.id);
  if ((entry.flags & ~kVdagChunkRequired) != 0) fail_at(place, "unknown flags");
  if (entry.offset != expected_offset)
    fail_at(place, "starts at byte " + std::to_string(entry.offset) + ", expected byte " +
                       std::to_string(expected_offset));
  // `expected_offset` is at most file.size(), which is below 2^63, so aligning cannot overflow.
  if (entry.length > file.size() - expected_offset ||
      vdag_align(entry.length) > file.size() - expected_offset)
    fail_at(place, "extends past the end of the file");
  const bool required = (entry.flags & kVdagChunkRequired) != 0;
  constexpr std::uint32_t kKnown[] = {kChunkMeta,          kChunkLevels,     kChunkNodes,
                                      kChunkLongNodes,     kChunkLeafBlocks, kChunkCompactHead,
                                      kChunkCompactStream, kChunkEsvo,       kChunkEsvoBlocks};
  if (required && std::find(std::begin(kKnown), std::end(kKnown), entry.id) == std::end(kKnown))
    fail_at(place, "unknown required chunk: this file needs a newer version of voxdag");
  return {entry.id, required, entry.offset, entry.checksum,
          file.subspan(entry.offset, entry.length)};
}

}  // namespace

std::vector<VdagChunk> read_vdag_chunks(std::span<const std::byte> file) {
  assert(reinterpret_cast<std::uintptr_t>(file.data()) % alignof(std::uint64_t) == 0);
  const VdagHeader header = read_header(file);
  const std::size_t table_end =
      sizeof header + std::size_t{header.chunk_count} * sizeof(VdagChunkEntry);
  check_header_checksum(file, table_end, header.checksum);

  std::uint64_t end = vdag_align(table_end);
  if (end > file.size()) fail_at("chunk table", "truncated: the file ends inside the padding");
  check_padding(file, table_end, end);
  std::vector<VdagChunk> chunks;
  for (std::size_t i = 0; i < header.chunk_count; ++i) {
    VdagChunkEntry entry;
    std::memcpy(&entry, file.data() + sizeof header + i * sizeof entry, sizeof entry);
    for (const VdagChunk& other : chunks)
      if (other.id == entry.id) fail_at(table_place(entry.id), "duplicate chunk");
    chunks.push_back(read_entry(file, entry, end));
    const std::uint64_t data_end = end + entry.length;
    end = vdag_align(data_end);
    check_padding(file, data_end, end);
  }
  if (end != file.size()) fail_at(ErrorPlace::byte(end), "has bytes after the last chunk");
  return chunks;
}

const VdagChunk* find_chunk(const std::vector<VdagChunk>& chunks, std::uint32_t id) {
  const auto found = std::find_if(chunks.begin(), chunks.end(),
                                  [id](const VdagChunk& chunk) { return chunk.id == id; });
  return found == chunks.end() ? nullptr : &*found;
}

void check_vdag_checksums(const std::vector<VdagChunk>& chunks) {
  for (const VdagChunk& chunk : chunks)
    if (xxh3_64(chunk.bytes) != chunk.checksum) fail_at(chunk_place(chunk.id), "checksum is wrong");
}

std::span<const std::byte> chunk_bytes(const std::vector<VdagChunk>& chunks, std::uint32_t id,
                                       std::size_t multiple) {
  const VdagChunk* const chunk = find_chunk(chunks, id);
  if (chunk == nullptr) fail_at("chunk table", "chunk " + vdag_chunk_name(id) + " is missing");
  if (chunk->bytes.size() % multiple != 0)
    fail_at(chunk_place(id), "length in bytes is not a multiple of " + std::to_string(multiple));
  return chunk->bytes;
}

std::string_view metadata_chunk_text(const std::vector<VdagChunk>& chunks) {
  const std::span<const std::byte> bytes = chunk_bytes(chunks, kChunkMeta, 1);
  if (bytes.size() > kVdagMaxMetadataBytes)
    fail_at(chunk_place(kChunkMeta),
            "is longer than " + std::to_string(kVdagMaxMetadataBytes) + " bytes");
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

VdagMetadata read_vdag_metadata(const std::vector<VdagChunk>& chunks) {
  return read_metadata_chunk(chunks, parse_vdag_metadata);
}

namespace {

template <class Dag>
Dag read_dag(const std::vector<VdagChunk>& chunks, int levels, std::uint32_t node_chunk) {
  const auto table = chunk_values<std::uint64_t>(chunks, kChunkLevels);
  const auto nodes = chunk_values<std::uint32_t>(chunks, node_chunk);
  const auto leaf_blocks = chunk_values<std::uint64_t>(chunks, kChunkLeafBlocks);
  if (table.size() != static_cast<std::size_t>(levels - 1))
    fail_at(chunk_place(kChunkLevels), "has " + std::to_string(table.size()) +
                                           " values, but a grid of " + std::to_string(levels) +
                                           " levels needs " + std::to_string(levels - 1));
  if (table.back() != nodes.size())
    fail_at(chunk_place(node_chunk), "has " + std::to_string(nodes.size()) +
                                         " words, but the level table says " +
                                         std::to_string(table.back()));
  Dag view;
  view.levels = levels;
  view.nodes = nodes.data();
  view.leaf_blocks = leaf_blocks.data();
  view.leaf_block_count = leaf_blocks.size();
  std::copy(table.begin(), table.end(), view.level_begin);
  std::fill(view.level_begin + table.size(), std::end(view.level_begin), table.back());
  return view;
}

template <class Dag>
void check_dag(const Dag& view, void (*check)(const Dag&), std::uint32_t node_chunk) {
  try {
    check(view);
  } catch (const Error& error) {
    const bool leaf = error.place().has(ErrorPlace::Kind::kLeafBlock);
    const bool table = error.place().has(ErrorPlace::Kind::kLevelTable);
    throw error.within(chunk_place(leaf ? kChunkLeafBlocks : table ? kChunkLevels : node_chunk));
  }
}

}  // namespace

SvdagView read_vdag_svdag(const std::vector<VdagChunk>& chunks, int levels) {
  if (has_chunk(chunks, kChunkLongNodes))
    fail_at("",
            "has long pointers (more than 2^32 node words), but a plain DAG is needed: voxdag crop "
            "and voxdag coarsen make one");
  return read_dag<SvdagView>(chunks, levels, kChunkNodes);
}

LongSvdagView read_vdag_long_svdag(const std::vector<VdagChunk>& chunks, int levels) {
  for (const std::uint32_t id :
       {kChunkNodes, kChunkCellIndex, kChunkColors, kChunkNormals, kChunkMaterials, kChunkChannels,
        kChunkWireColors, kChunkWireNormals, kChunkWireMaterials})
    if (has_chunk(chunks, id)) fail_at(table_place(id), "does not go with the chunk NODX");
  return read_dag<LongSvdagView>(chunks, levels, kChunkLongNodes);
}

void check_vdag_svdag(const SvdagView& view, void (*check)(const SvdagView&)) {
  check_dag(view, check, kChunkNodes);
}
void check_vdag_svdag(const LongSvdagView& view, void (*check)(const LongSvdagView&)) {
  check_dag(view, check, kChunkLongNodes);
}

VdagContents parse_vdag(std::span<const std::byte> file) {
  VdagContents contents;
  contents.chunks = read_vdag_chunks(file);
  if (has_chunk(contents.chunks, kChunkEsvo)) fail_at("", "holds an ESVO, but a DAG is needed");
  if (has_chunk(contents.chunks, kChunkCompactStream))
    fail_at("", "holds a compact DAG, but one in the plain form is needed: voxdag convert --plain");
  check_vdag_checksums(contents.chunks);
  expand_wire_chunks(contents.chunks, contents.expanded);
  contents.metadata = read_vdag_metadata(contents.chunks);
  contents.view = read_vdag_svdag(contents.chunks, contents.metadata.grid.levels);
  check_vdag_svdag(contents.view, validate_svdag);
  contents.attributes = read_attribute_chunks(contents.chunks, contents.view);
  return contents;
}

}  // namespace voxdag
