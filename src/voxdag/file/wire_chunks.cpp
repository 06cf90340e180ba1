#include "voxdag/file/wire_chunks.hpp"

#include <algorithm>
#include <cstring>
#include <string>
#include <utility>

#include "voxdag/core/checked_size.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/with_file_name.hpp"
#include "voxdag/file/attribute_chunks.hpp"
#include "voxdag/file/vdag_format.hpp"

namespace voxdag {
namespace {

struct WireKind {
  std::uint32_t wire, expanded;  ///< Ids of chunks.
  std::uint64_t WireBytes::*bytes;
};
constexpr WireKind kWireKinds[] = {{kChunkWireColors, kChunkColors, &WireBytes::colors},
                                   {kChunkWireNormals, kChunkNormals, &WireBytes::normals},
                                   {kChunkWireMaterials, kChunkMaterials, &WireBytes::materials}};

/// The parts of a chunk in the wire form, and the sizes of the chunk that it stands for.
struct WireParts {
  WireHeader header;
  std::span<const wire::WireSegment> segments;
  std::span<const std::byte> coded;
  CellPagesView pages;  ///< Without arrays.

  /// Returns the 64-bit words of the expanded chunk.
  std::uint64_t expanded_words() const {
    return sizeof(ValuePagesHeader) / 8 + pages.group_count() + pages.word_count +
           (pages.page_count() + 3) / 4;
  }
};

WireParts read_parts(std::span<const std::byte> bytes) {
  WireParts parts;
  if (bytes.size() < sizeof parts.header || bytes.size() % 8 != 0)
    fail_at("", "has " + std::to_string(bytes.size()) +
                    " bytes: fewer than its header, or no multiple of 8");
  std::memcpy(&parts.header, bytes.data(), sizeof parts.header);
  const WireHeader& header = parts.header;
  if (header.reserved != 0 || std::any_of(std::begin(header.padding), std::end(header.padding),
                                          [](std::uint64_t word) { return word != 0; }))
    fail_at("", "reserved bytes of the header are not zero");
  if (header.words > kMaxWireExpansion * bytes.size() / 8)
    fail_at("", "expands to " + std::to_string(header.words) +
                    " words, more than allowed for its " + std::to_string(bytes.size()) + " bytes");
  parts.pages.values = header.values;
  parts.pages.word_count = header.words;
  // A page takes at least a byte. So this bounds the tables, too.
  if (parts.pages.page_count() > 8 * header.words)
    fail_at("", "has too few words for " + std::to_string(header.values) + " values");
  const std::uint64_t segments = wire::segment_count(parts.pages.page_count());
  const std::uint64_t rest = bytes.size() - sizeof header;
  if (segments > rest / sizeof(wire::WireSegment) ||
      header.coded_bytes > rest - segments * sizeof(wire::WireSegment) ||
      (header.coded_bytes + 7) / 8 * 8 != rest - segments * sizeof(wire::WireSegment))
    fail_at("", "has " + std::to_string(bytes.size()) + " bytes, but its header needs others");
  const std::byte* const table = bytes.data() + sizeof header;
  parts.segments = {reinterpret_cast<const wire::WireSegment*>(table), checked_size(segments)};
  parts.coded =
      bytes.subspan(sizeof header + segments * sizeof(wire::WireSegment), header.coded_bytes);
  const std::size_t padding = (8 - header.coded_bytes % 8) % 8;
  for (std::size_t i = bytes.size() - padding; i < bytes.size(); ++i)
    if (bytes[i] != std::byte{0}) fail_at("", "padding is not zero");
  return parts;
}

void decode(std::uint32_t id, const WireParts& parts, const wire::PagesTarget& target) {
  const std::uint32_t parameter = parts.header.parameter;
  if (id == kChunkMaterials) {
    if (parameter == 0 || parameter > kMaxMaterials)
      fail_at("", "has " + std::to_string(parameter) + " materials; 1 to 65,535 are allowed");
    return wire::decode_wire_materials(parts.segments, parts.coded, parameter, target);
  }
  if (parameter > PagePrecision::kMaxCode)
    fail_at("", "unknown precision " + std::to_string(parameter) + ": 0 to 7 are allowed");
  wire::decode_wire_values(parts.segments, parts.coded, PagePrecision{static_cast<int>(parameter)},
                           id == kChunkColors ? wire::ValueKind::kColor : wire::ValueKind::kNormal,
                           target);
}

/// Sets `memory` to the bytes of the chunk `id` that the parts stand for. Returns them.
std::span<const std::byte> expand(std::uint32_t id, const WireParts& parts,
                                  std::unique_ptr<std::uint64_t[]>& memory) {
  const std::uint64_t words = parts.expanded_words();
  memory = std::make_unique<std::uint64_t[]>(checked_size(words));
  // All kinds of pages have headers like this one.
  ValuePagesHeader header{};
  static_assert(offsetof(ValuePagesHeader, precision) == offsetof(MaterialIdsHeader, materials) &&
                offsetof(ValuePagesHeader, values) == offsetof(MaterialIdsHeader, values) &&
                offsetof(ValuePagesHeader, words) == offsetof(MaterialIdsHeader, words) &&
                sizeof(ValuePagesHeader) == sizeof(MaterialIdsHeader));
  header.precision = parts.header.parameter;
  header.values = parts.header.values;
  header.words = parts.header.words;
  std::memcpy(memory.get(), &header, sizeof header);
  std::uint64_t* const groups = memory.get() + sizeof header / 8;
  std::uint64_t* const of_pages = groups + parts.pages.group_count();
  auto* const pages = reinterpret_cast<std::uint16_t*>(of_pages + header.words);
  decode(id, parts, {groups, pages, of_pages, header.words, header.values});
  return std::as_bytes(std::span(memory.get(), words));
}

/// Calls work(chunk, kind) for each chunk in the wire form. Errors name it.
template <class Chunks, class Work>
void each_wire_chunk(Chunks& chunks, const Work& work) {
  for (auto& chunk : chunks)
    for (const WireKind& kind : kWireKinds) {
      if (chunk.id != kind.wire) continue;
      try {
        if (has_chunk(chunks, kind.expanded))
          fail_at("", "stands for the chunk " + vdag_chunk_name(kind.expanded) +
                          ", which the file also has");
        work(chunk, kind);
      } catch (const Error& error) {
        throw error.within(ErrorPlace::chunk(vdag_chunk_name(kind.wire)));
      }
      break;
    }
}

}  // namespace

WireChunk::WireChunk(std::uint32_t id, std::uint32_t parameter, const CellPagesView& pages,
                     wire::WireValues values)
    : id_(id), values_(std::move(values)) {
  header_.parameter = parameter;
  header_.values = pages.values;
  header_.words = pages.word_count;
  header_.coded_bytes = values_.bytes.size();
}

WireChunk::WireChunk(const ValuePagesView& pages, wire::ValueKind kind)
    : WireChunk(kind == wire::ValueKind::kColor ? kChunkWireColors : kChunkWireNormals,
                static_cast<std::uint32_t>(pages.precision.code), pages,
                wire::encode_wire_values(pages, kind)) {}

WireChunk::WireChunk(const MaterialIdsView& pages)
    : WireChunk(kChunkWireMaterials, pages.materials, pages, wire::encode_wire_materials(pages)) {}

OutputChunk WireChunk::chunk() const {
  static constexpr std::byte kZeros[8]{};
  return {id_,
          0,
          {std::as_bytes(std::span(&header_, 1)), std::as_bytes(std::span(values_.segments)),
           values_.bytes, std::span(kZeros, (8 - values_.bytes.size() % 8) % 8)}};
}

bool WireChunk::is_allowed() const {
  return header_.words <= kMaxWireExpansion * chunk().length() / 8;
}

bool has_wire_chunk(const std::vector<VdagChunk>& chunks) {
  return std::any_of(std::begin(kWireKinds), std::end(kWireKinds),
                     [&](const WireKind& kind) { return has_chunk(chunks, kind.wire); });
}

void expand_wire_chunks(std::vector<VdagChunk>& chunks, ExpandedChunks& memory) {
  each_wire_chunk(chunks, [&](VdagChunk& chunk, const WireKind& kind) {
    std::unique_ptr<std::uint64_t[]> bytes;
    chunk.bytes = expand(kind.expanded, read_parts(chunk.bytes), bytes);
    chunk.id = kind.expanded;
    memory.push_back(std::move(bytes));
  });
}

WireBytes wire_bytes_of(const VdagContainer& file) {
  WireBytes bytes;
  with_file_name(file.path().string(), [&] {
    const std::vector<VdagChunk> chunks = file.chunks();
    each_wire_chunk(chunks, [&](const VdagChunk& chunk, const WireKind& kind) {
      bytes.*kind.bytes = chunk.bytes.size();
      bytes.expanded += 8 * read_parts(chunk.bytes).expanded_words();
    });
  });
  return bytes;
}

}  // namespace voxdag
