#include "voxdag/formats/imports/colors/colored_voxel_builder.hpp"

#include <optional>

#include "voxdag/algebra/voxels/morton_builder.hpp"
#include "voxdag/algebra/voxels/voxel_builder.hpp"
#include "voxdag/formats/imports/colors/cell_colors.hpp"
#include "voxdag/stored/attributes/build_cell_index.hpp"

namespace voxdag {

ColoredVoxelBuilder::ColoredVoxelBuilder(int levels, std::size_t most_colors,
                                         const std::filesystem::path& folder, MemoryBudget* memory,
                                         Progress* progress, ColorRule rule)
    : levels_(levels),
      memory_(memory),
      rule_(rule),
      colors_(most_colors, folder, memory, progress) {}

void ColoredVoxelBuilder::add(Vec3i voxel, Rgb8 color) {
  if (rule_ == ColorRule::kLast && added_ != UINT32_MAX) ++added_;
  colors_.add({code_in_grid(voxel, levels_), added_,
               color[0] | std::uint32_t{color[1]} << 8 | std::uint32_t{color[2]} << 16});
}

ColoredVoxelBuilder::Result ColoredVoxelBuilder::finish(double color_bound) {
  Result result;
  {
    MortonBuilder builder(levels_, memory_);
    colors_.visit_all([&](const ColoredCode& record) { builder.add(record.code); });
    result.dag = builder.finish();
  }
  const SvdagView dag = result.dag.view();
  const MemoryReservation dag_bytes(memory_, dag.bytes());
  DagAttributes& attributes = result.attributes;
  attributes.index = build_cell_index(dag, levels_, memory_);
  const MemoryReservation index_bytes(memory_, attributes.index.view().bytes());
  ValueEncoder encoder(attributes.index.cells, make_value_metric(kColorWeights, 255 * color_bound),
                       memory_);
  CellColors cells(levels_, encoder);
  const auto add_color = [&](const ColoredCode& record) {
    cells.add(record.code, {static_cast<std::uint8_t>(record.color),
                            static_cast<std::uint8_t>(record.color >> 8),
                            static_cast<std::uint8_t>(record.color >> 16)});
  };
  if (rule_ == ColorRule::kMean) {
    colors_.visit_all(add_color);
  } else {
    std::optional<ColoredCode> last;
    colors_.visit_all([&](const ColoredCode& record) {
      if (last && last->code != record.code) add_color(*last);
      last = record;
    });
    if (last) add_color(*last);
  }
  cells.finish();
  attributes.colors = encoder.finish();
  attributes.color_errors = encoder.errors();
  return result;
}

}  // namespace voxdag
