#include "voxdag/builders/attributes/build_attributes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>

#include "voxdag/builders/attributes/filter_materials.hpp"
#include "voxdag/stored/attributes/build_cell_index.hpp"
#include "voxdag/stored/attributes/encode_channels.hpp"

namespace voxdag {
namespace {

/// Compresses the colours and normals of cells as soon as they come, and keeps the other numbers.
class AttributeEncoder : public CellValueSink {
 public:
  AttributeEncoder(std::uint64_t cells, const AttributeOptions& options, MemoryBudget* memory)
      : metallic(options.metallic ? cells : 0, memory),
        roughness(options.roughness ? cells : 0, memory) {
    if (options.colors)
      colors = std::make_unique<ValueEncoder>(
          cells, make_value_metric(kColorWeights, 255 * options.color_bound), memory);
    if (options.normals)
      normals = std::make_unique<ValueEncoder>(
          cells, make_normal_metric(options.normal_bound_degrees), memory);
  }

  bool needs_normals() const override { return normals != nullptr; }

  void add(std::uint64_t first, std::span<const VoxelValue> values) override {
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!metallic.empty()) metallic[first + i] = values[i].metallic;
      if (!roughness.empty()) roughness[first + i] = values[i].roughness;
    }
    while (!values.empty()) {
      const std::uint64_t left_in_page = kPageValues - first % kPageValues;
      const auto part = values.first(std::min<std::size_t>(values.size(), left_in_page));
      if (colors)
        add_packed(*colors, first, part, [](const VoxelValue& v) {
          return Value8{v.color[0], v.color[1], v.color[2]};
        });
      if (normals)
        add_packed(*normals, first, part,
                   [](const VoxelValue& v) { return pack_normal(v.normal); });
      first += part.size();
      values = values.subspan(part.size());
    }
  }

  std::unique_ptr<ValueEncoder> colors, normals;
  CountedVector<std::uint8_t> metallic, roughness;  ///< By number of cell; empty: not wanted.

 private:
  /// Packs and adds values of one page.
  template <class Pack>
  static void add_packed(ValueEncoder& encoder, std::uint64_t first,
                         std::span<const VoxelValue> values, const Pack& pack) {
    std::array<Value8, kPageValues> packed;
    std::transform(values.begin(), values.end(), packed.begin(), pack);
    encoder.add(first, std::span(packed).first(values.size()));
  }
};

}  // namespace

void AttributeOptions::add_channel(std::string_view name) {
  if (name == "metallic")
    metallic = true;
  else if (name == "roughness")
    roughness = true;
  else
    throw std::invalid_argument("\"" + std::string(name) + "\" is neither metallic nor roughness");
}

DagAttributes build_attributes(const Mesh& mesh, const Grid& grid, const SvdagView& dag,
                               const SurfaceShading* shading, const AttributeOptions& options,
                               Work work) {
  DagAttributes result;
  result.index = build_cell_index(dag, options.finest_level, work.memory);
  const MemoryReservation index_bytes(work.memory, result.index.view().bytes());
  if (options.materials)
    result.materials = filter_materials(mesh, grid, dag, result.index.view(), work, options.ids);
  const MemoryReservation material_bytes(work.memory, result.materials.view().bytes());
  if (!options.colors && !options.normals && !options.has_channels()) return result;
  AttributeEncoder encoder(result.index.cells, options, work.memory);
  filter_cells(mesh, grid, dag, result.index.view(), shading, encoder, work);
  const auto finish = [](std::unique_ptr<ValueEncoder>& values, ValuePages& pages,
                         ValueErrors& errors) {
    if (!values) return;
    pages = values->finish();
    errors = values->errors();
    values.reset();
  };
  finish(encoder.colors, result.colors, result.color_errors);
  const MemoryReservation color_bytes(work.memory, result.colors.view().bytes());
  finish(encoder.normals, result.normals, result.normal_errors);
  const MemoryReservation normal_bytes(work.memory, result.normals.view().bytes());
  std::vector<EncodedChannel> channels;
  const auto encode = [&](const char* name, CountedVector<std::uint8_t>& values) {
    if (values.empty()) return;
    channels.push_back(encode_channel({name, ChannelKind::kU8, 0}, values, work));
    values = CountedVector<std::uint8_t>(work.memory);
  };
  encode("metallic", encoder.metallic);
  encode("roughness", encoder.roughness);
  // The channels, and their copies in the result.
  const MemoryReservation channel_bytes(work.memory, 2 * bytes_of(channels));
  result.channels = join_channels(result.index.cells, channels);
  return result;
}

std::uint64_t count_cells(const SvdagCounts& counts, int level) {
  std::uint64_t cells = 0;
  const int levels = static_cast<int>(counts.svo_nodes_per_level.size());
  for (int l = 0; l <= level && l < levels; ++l)
    cells += counts.svo_nodes_per_level[static_cast<std::size_t>(l)];
  return level == levels ? cells + counts.voxels : cells;
}

int finest_level_within(const SvdagCounts& counts, const AttributeOptions& options,
                        std::uint64_t bytes) {
  const std::uint64_t bits_per_cell =
      (options.colors ? 8u : 0u) + (options.normals ? 8u : 0u) + (options.materials ? 1u : 0u) +
      (options.metallic ? 16u : 0u) + (options.roughness ? 16u : 0u);
  int level = static_cast<int>(counts.svo_nodes_per_level.size());
  while (level > 0 && (count_cells(counts, level) + 7) / 8 * bits_per_cell > bytes) --level;
  return level;
}

}  // namespace voxdag
