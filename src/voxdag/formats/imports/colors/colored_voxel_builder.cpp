#include "voxdag/formats/imports/colors/colored_voxel_builder.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <vector>

#include "voxdag/algebra/voxels/morton_builder.hpp"
#include "voxdag/algebra/voxels/voxel_builder.hpp"
#include "voxdag/formats/imports/colors/linear_color.hpp"
#include "voxdag/formats/imports/voxel_source.hpp"
#include "voxdag/stored/attributes/build_cell_index.hpp"
#include "voxdag/stored/attributes/value_encoder.hpp"

namespace voxdag {
namespace {

/// Takes the colours of voxels in Morton order, and gives the encoder those of all cells by their
/// numbers (stored/attributes/cell_index.hpp). A voxel has the mean of its colours, and a cell that
/// of its voxels, in linear light.
class CellColors {
 public:
  /// A grid of 2^levels voxels a side. Refers to the encoder, which must expect all its cells.
  CellColors(int levels, ValueEncoder& encoder);

  /// Adds a colour of the voxel of a Morton code. Codes do not descend. Throws OverMemory.
  void add(std::uint64_t code, Rgb8 color);
  /// Call it last. Throws OverMemory.
  void finish();

 private:
  /// A cell on the path to the last voxel.
  struct OpenCell {
    std::uint64_t number = 0;
    std::array<std::uint64_t, 3> sum{};  ///< Of the colours, in linear light.
    std::uint64_t count = 0;             ///< Of colours.
  };

  void open(int level);
  void close(int level);

  int levels_;
  ValueEncoder& encoder_;
  std::vector<OpenCell> path_;  ///< By level.
  std::uint64_t code_ = 0, cells_ = 0;
  /// The values of the cells of a subtree, which the encoder gets together.
  int block_level_;
  std::vector<Value8> block_;
};

CellColors::CellColors(int levels, ValueEncoder& encoder)
    : levels_(levels),
      encoder_(encoder),
      path_(static_cast<std::size_t>(levels) + 1),
      block_level_(std::max(levels - 3, 0)) {}

void CellColors::add(std::uint64_t code, Rgb8 color) {
  // The cells above this level are those of the last voxel, too.
  int level = 0;
  if (cells_ > 0) {
    const auto different_bits = static_cast<int>(std::bit_width(code ^ code_));
    level = levels_ + 1 - (different_bits + 2) / 3;
    for (int l = levels_; l >= level; --l) close(l);
  }
  for (; level <= levels_; ++level) open(level);
  code_ = code;
  OpenCell& voxel = path_.back();
  ++voxel.count;
  for (std::size_t channel = 0; channel < 3; ++channel)
    voxel.sum[channel] += linear_of(color[channel]);
}

void CellColors::finish() {
  if (cells_ == 0) return;
  for (int level = levels_; level >= 0; --level) close(level);
}

void CellColors::open(int level) {
  if (level == block_level_) block_.clear();
  if (level >= block_level_) block_.emplace_back();
  path_[level] = {cells_++, {}, 0};
}

void CellColors::close(int level) {
  const OpenCell& cell = path_[level];
  std::array<std::uint16_t, 3> mean{};
  for (std::size_t channel = 0; channel < 3; ++channel)
    mean[channel] = static_cast<std::uint16_t>((cell.sum[channel] + cell.count / 2) / cell.count);
  const Value8 value{encoded_of(mean[0]), encoded_of(mean[1]), encoded_of(mean[2])};
  if (level > 0) {
    OpenCell& above = path_[static_cast<std::size_t>(level) - 1];
    const bool is_voxel = level == levels_;
    above.count += is_voxel ? 1 : cell.count;
    for (std::size_t channel = 0; channel < 3; ++channel)
      above.sum[channel] += is_voxel ? mean[channel] : cell.sum[channel];
  }
  if (level < block_level_) return encoder_.add(cell.number, {&value, 1});
  const std::uint64_t first = path_[block_level_].number;
  block_[cell.number - first] = value;
  if (level == block_level_) encoder_.add(first, block_);
}

}  // namespace

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
