#include "voxdag/file/attribute_chunks.hpp"

#include <algorithm>
#include <cstring>

#include "voxdag/core/error.hpp"
#include "voxdag/file/vdag_format.hpp"
#include "voxdag/file/wire_chunks.hpp"
#include "voxdag/stored/attributes/build_cell_index.hpp"
#include "voxdag/stored/attributes/validate_channels.hpp"
#include "voxdag/stored/attributes/validate_pages.hpp"

namespace voxdag {
namespace {

constexpr std::uint32_t kValueChunks[] = {kChunkColors, kChunkNormals, kChunkMaterials,
                                          kChunkChannels};

template <class Header>
Header read_header(std::span<const std::byte> bytes) {
  Header header;
  if (bytes.size() < sizeof header)
    fail_at("", "has " + std::to_string(bytes.size()) + " bytes, but its header needs " +
                    std::to_string(sizeof header));
  if (bytes.size() % 8 != 0) fail_at("", "length in bytes is not a multiple of 8");
  std::memcpy(&header, bytes.data(), sizeof header);
  return header;
}

template <class T, std::size_t n>
void check_zeros(std::uint32_t reserved, const T (&padding)[n]) {
  if (reserved != 0 || std::any_of(padding, padding + n, [](T v) { return v != 0; }))
    fail_at("", "reserved bytes of the header are not zero");
}

CellIndexView read_index(std::span<const std::byte> bytes, const SvdagView& dag) {
  const auto header = read_header<CellIndexHeader>(bytes);
  check_zeros(header.reserved, header.padding);
  if (header.finest_level > static_cast<std::uint32_t>(dag.levels))
    fail_at("", "its finest level, " + std::to_string(header.finest_level) +
                    ", is finer than the voxels, level " + std::to_string(dag.levels));
  CellIndexView index;
  index.words = reinterpret_cast<const std::uint64_t*>(bytes.data() + sizeof header);
  index.finest_level = static_cast<std::uint8_t>(header.finest_level);
  index.cells = header.cells;
  std::uint64_t words = 0;
  for (int level = 0; level < kMaxLevels; ++level) {
    index.width[level] = header.width[level];
    index.begin[level] = words;
    const std::uint64_t slots = dag.level_begin[level + 1] - dag.level_begin[level];
    words += (slots * header.width[level] + 63) / 64;
  }
  index.begin[kMaxLevels] = words;
  if (words != (bytes.size() - sizeof header) / 8)
    fail_at("", "has " + std::to_string((bytes.size() - sizeof header) / 8) +
                    " words, but its header needs " + std::to_string(words));
  validate_cell_index(dag, index);
  return index;
}

/// Sets the arrays of `view`, whose counts the header has, to those of the chunk. Throws Error
/// unless the chunk has exactly these arrays, for `cells` cells.
template <class Header, class View>
void read_tables(std::span<const std::byte> bytes, const Header& header, std::uint64_t cells,
                 View& view) {
  check_zeros(header.reserved, header.padding);
  if (header.values != cells)
    fail_at("", "has " + std::to_string(header.values) + " values, but the DAG has " +
                    std::to_string(cells) + " numbered cells");
  view.values = header.values;
  view.word_count = header.words;
  // The difference cannot overflow, but the sum of both counts could.
  const std::uint64_t words = (bytes.size() - sizeof header) / 8;
  const std::uint64_t table_words = view.group_count() + (view.page_count() + 3) / 4;
  if (header.words > words || table_words != words - header.words)
    fail_at("", "has " + std::to_string(words) + " words, but its tables need " +
                    std::to_string(table_words) + " and its pages " + std::to_string(header.words));
  const auto* const first = reinterpret_cast<const std::uint64_t*>(bytes.data() + sizeof header);
  view.groups = first;
  view.words = first + view.group_count();
  view.pages = reinterpret_cast<const std::uint16_t*>(view.words + view.word_count);
  for (std::uint64_t page = view.page_count(); page % 4 != 0; ++page)
    if (view.pages[page] != 0) fail_at("", "padding is not zero");
}

ValuePagesView read_pages(std::span<const std::byte> bytes, std::uint64_t cells) {
  const auto header = read_header<ValuePagesHeader>(bytes);
  if (header.precision > PagePrecision::kMaxCode)
    fail_at("", "unknown precision " + std::to_string(header.precision) + ": 0 to 7 are allowed");
  ValuePagesView view;
  view.precision = {static_cast<int>(header.precision)};
  read_tables(bytes, header, cells, view);
  validate_value_pages(view);
  return view;
}

MaterialIdsView read_materials(std::span<const std::byte> bytes, std::uint64_t cells) {
  const auto header = read_header<MaterialIdsHeader>(bytes);
  MaterialIdsView view;
  view.materials = header.materials;
  read_tables(bytes, header, cells, view);
  validate_material_ids(view);
  return view;
}

ChannelsView read_channels(std::span<const std::byte> bytes, std::uint64_t cells) {
  if (bytes.size() % 8 != 0) fail_at("", "length in bytes is not a multiple of 8");
  return validate_channels({reinterpret_cast<const std::uint64_t*>(bytes.data()), bytes.size() / 8},
                           cells);
}

void set_kind(ValuePagesHeader& header, const ValuePagesView& view) {
  header.precision = static_cast<std::uint32_t>(view.precision.code);
}
void set_kind(MaterialIdsHeader& header, const MaterialIdsView& view) {
  header.materials = view.materials;
}

/// Calls work(bytes) for the chunk, if the file has it, and returns whether it has. Errors name the
/// chunk.
template <class Work>
bool read_chunk(const std::vector<VdagChunk>& chunks, std::uint32_t id, const Work& work) {
  const VdagChunk* const chunk = find_chunk(chunks, id);
  if (chunk == nullptr) return false;
  try {
    work(chunk->bytes);
  } catch (const Error& error) {
    throw error.within(ErrorPlace::chunk(vdag_chunk_name(id)));
  }
  return true;
}

}  // namespace

AttributeChunks::~AttributeChunks() = default;

AttributeChunks::AttributeChunks(const DagAttributesView& attributes, Index of_cells,
                                 AttributeForm form) {
  if (attributes.is_empty()) return;
  if (of_cells == Index::kStored) {
    const CellIndexView& index = attributes.index;
    index_.finest_level = index.finest_level;
    index_.cells = index.cells;
    std::copy(std::begin(index.width), std::end(index.width), std::begin(index_.width));
    chunks_.push_back({kChunkCellIndex,
                       0,
                       {std::as_bytes(std::span(&index_, 1)),
                        std::as_bytes(std::span(index.words, index.word_count()))}});
  }
  const auto add_values = [&](std::uint32_t id, const ValuePagesView& pages,
                              ValuePagesHeader& header, wire::ValueKind kind) {
    if (pages.is_empty() ||
        (form == AttributeForm::kWire && add_wire(std::make_unique<WireChunk>(pages, kind))))
      return;
    add(id, pages, header);
  };
  add_values(kChunkColors, attributes.colors, colors_, wire::ValueKind::kColor);
  add_values(kChunkNormals, attributes.normals, normals_, wire::ValueKind::kNormal);
  const MaterialIdsView& ids = attributes.materials;
  if (attributes.has_materials() &&
      (form == AttributeForm::kPages || !add_wire(std::make_unique<WireChunk>(ids))))
    add(kChunkMaterials, ids, materials_);
  if (const ChannelsView& channels = attributes.channels; !channels.is_empty())
    chunks_.push_back(
        {kChunkChannels, 0, {std::as_bytes(std::span(channels.words, channels.bytes() / 8))}});
}

bool AttributeChunks::add_wire(std::unique_ptr<WireChunk> chunk) {
  if (!chunk->is_allowed()) return false;
  chunks_.push_back(chunk->chunk());
  wire_.push_back(std::move(chunk));
  return true;
}

template <class View, class Header>
void AttributeChunks::add(std::uint32_t id, const View& pages, Header& header) {
  static constexpr std::byte kZeros[6]{};
  set_kind(header, pages);
  header.values = pages.values;
  header.words = pages.word_count;
  const std::uint64_t padding = (4 - pages.page_count() % 4) % 4 * sizeof(std::uint16_t);
  chunks_.push_back({id,
                     0,
                     {std::as_bytes(std::span(&header, 1)),
                      std::as_bytes(std::span(pages.groups, pages.group_count())),
                      std::as_bytes(std::span(pages.words, pages.word_count)),
                      std::as_bytes(std::span(pages.pages, pages.page_count())),
                      std::span<const std::byte>(kZeros, padding)}});
}

bool has_attribute_values(const std::vector<VdagChunk>& chunks) {
  return has_wire_chunk(chunks) ||
         std::any_of(std::begin(kValueChunks), std::end(kValueChunks),
                     [&](std::uint32_t id) { return has_chunk(chunks, id); });
}

DagAttributesView read_attribute_values(const std::vector<VdagChunk>& chunks,
                                        const CellIndexView& index) {
  DagAttributesView attributes;
  attributes.index = index;
  const auto read_values = [&](std::uint32_t id, ValuePagesView& view) {
    read_chunk(chunks, id,
               [&](std::span<const std::byte> bytes) { view = read_pages(bytes, index.cells); });
  };
  read_values(kChunkColors, attributes.colors);
  read_values(kChunkNormals, attributes.normals);
  read_chunk(chunks, kChunkMaterials, [&](std::span<const std::byte> bytes) {
    attributes.materials = read_materials(bytes, index.cells);
  });
  read_chunk(chunks, kChunkChannels, [&](std::span<const std::byte> bytes) {
    attributes.channels = read_channels(bytes, index.cells);
  });
  return attributes;
}

DagAttributesView read_attribute_chunks(const std::vector<VdagChunk>& chunks,
                                        const SvdagView& dag) {
  CellIndexView index;
  const bool has_index = read_chunk(chunks, kChunkCellIndex, [&](std::span<const std::byte> bytes) {
    index = read_index(bytes, dag);
  });
  if (!has_index)
    for (const std::uint32_t id : kValueChunks)
      read_chunk(chunks, id, [](std::span<const std::byte>) {
        fail_at("", "needs the chunk CIDX, which is missing");
      });
  return read_attribute_values(chunks, index);
}

}  // namespace voxdag
