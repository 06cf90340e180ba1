#include "voxdag/attributes/build_attributes.hpp"

#include <cmath>
#include <memory>
#include <numbers>

#include "voxdag/layout/build_cell_index.hpp"

namespace voxdag {
namespace {

/// Returns the bound on errors of packed normals, in steps of 8 bits. The rest of the angle is for
/// the rounding to 8 bits.
double normal_steps(double degrees) {
  constexpr double kRounding = 0.866;  // half the diagonal of a step
  const double chord = 2 * 127 * std::sin(std::min(degrees, 180.0) * std::numbers::pi / 360);
  return std::max(chord - kRounding, 0.0) / std::numbers::sqrt3;
}

/// Compresses the values of cells as they come.
class AttributeEncoder : public CellValueSink {
 public:
  AttributeEncoder(std::uint64_t cells, const AttributeOptions& options) {
    if (options.colors)
      colors = std::make_unique<ValueEncoder>(
          cells, make_value_metric(kColorWeights, 255 * options.color_bound), options.memory);
    if (options.normals)
      normals = std::make_unique<ValueEncoder>(
          cells, make_value_metric({1, 1, 1}, normal_steps(options.normal_bound_degrees)),
          options.memory);
  }

  void add(std::uint64_t first, std::span<const VoxelValue> values) override {
    std::vector<Value8> packed(values.size());
    const auto encode = [&](std::unique_ptr<ValueEncoder>& encoder, const auto& pack) {
      if (!encoder) return;
      for (std::size_t i = 0; i < values.size(); ++i) packed[i] = pack(values[i]);
      encoder->add(first, packed);
    };
    encode(colors, [](const VoxelValue& v) { return Value8{v.color[0], v.color[1], v.color[2]}; });
    encode(normals, [](const VoxelValue& v) { return pack_normal(v.normal); });
  }

  std::unique_ptr<ValueEncoder> colors, normals;
};

}  // namespace

DagAttributes build_attributes(const Mesh& mesh, const Grid& grid, const SvdagView& dag,
                               const SurfaceShading* shading, const AttributeOptions& options,
                               Progress* progress) {
  DagAttributes result;
  result.index = build_cell_index(dag, options.finest_level);
  const MemoryReservation counted(options.memory, result.index.view().bytes());
  AttributeEncoder encoder(result.index.cells, options);
  filter_cells(mesh, grid, dag, result.index.view(), shading, encoder, options.memory, progress);
  const auto finish = [](std::unique_ptr<ValueEncoder>& values, ValuePages& pages,
                         ValueErrors& errors) {
    if (!values) return;
    pages = values->finish();
    errors = values->errors();
    values.reset();
  };
  finish(encoder.colors, result.colors, result.color_errors);
  finish(encoder.normals, result.normals, result.normal_errors);
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
  const std::uint64_t per_cell = (options.colors ? 1u : 0u) + (options.normals ? 1u : 0u);
  int level = static_cast<int>(counts.svo_nodes_per_level.size());
  while (level > 0 && count_cells(counts, level) * per_cell > bytes) --level;
  return level;
}

}  // namespace voxdag
