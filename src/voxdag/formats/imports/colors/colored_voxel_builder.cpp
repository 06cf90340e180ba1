#include "voxdag/formats/imports/colors/colored_voxel_builder.hpp"

#include <cstdint>
#include <optional>

#include "voxdag/algebra/voxels/morton_builder.hpp"
#include "voxdag/algebra/voxels/voxel_builder.hpp"
#include "voxdag/formats/imports/colors/cell_colors.hpp"

namespace voxdag {

ColoredVoxelBuilder::ColoredVoxelBuilder(int levels, std::size_t most_colors,
                                         const std::filesystem::path& folder, Work work,
                                         ColorRule rule)
    : levels_(levels), memory_(work.memory), rule_(rule), colors_(most_colors, folder, work) {}

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
  const MemoryReservation dag_bytes(memory_, result.dag.view().bytes());
  result.attributes =
      encode_cell_colors(result.dag.view(), color_bound, memory_, [&](CellColors& cells) {
        const auto add_color = [&](const ColoredCode& record) {
          cells.add(record.code, {static_cast<std::uint8_t>(record.color),
                                  static_cast<std::uint8_t>(record.color >> 8),
                                  static_cast<std::uint8_t>(record.color >> 16)});
        };
        if (rule_ == ColorRule::kMean) return colors_.visit_all(add_color);
        std::optional<ColoredCode> last;
        colors_.visit_all([&](const ColoredCode& record) {
          if (last && last->code != record.code) add_color(*last);
          last = record;
        });
        if (last) add_color(*last);
      });
  return result;
}

}  // namespace voxdag
