#include "voxdag/formats/imports/colors/colored_voxel_builder.hpp"

#include "voxdag/algebra/voxels/morton_builder.hpp"
#include "voxdag/algebra/voxels/voxel_builder.hpp"
#include "voxdag/formats/imports/colors/cell_colors.hpp"
#include "voxdag/stored/attributes/build_cell_index.hpp"

namespace voxdag {

ColoredVoxelBuilder::ColoredVoxelBuilder(int levels, std::size_t most_colors,
                                         const std::filesystem::path& folder, Work work)
    : levels_(levels), memory_(work.memory), colors_(most_colors, folder, work) {}

void ColoredVoxelBuilder::add(Vec3i voxel, Rgb8 color) {
  colors_.add({code_in_grid(voxel, levels_),
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
  colors_.visit_all([&](const ColoredCode& record) {
    cells.add(record.code, {static_cast<std::uint8_t>(record.color),
                            static_cast<std::uint8_t>(record.color >> 8),
                            static_cast<std::uint8_t>(record.color >> 16)});
  });
  cells.finish();
  attributes.colors = encoder.finish();
  attributes.color_errors = encoder.errors();
  return result;
}

}  // namespace voxdag
