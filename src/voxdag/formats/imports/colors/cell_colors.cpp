#include "voxdag/formats/imports/colors/cell_colors.hpp"

#include <algorithm>
#include <bit>

#include "voxdag/formats/imports/colors/linear_color.hpp"
#include "voxdag/stored/attributes/build_cell_index.hpp"

namespace voxdag {

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

DagAttributes encode_cell_colors(const SvdagView& dag, double color_bound, MemoryBudget* memory,
                                 const std::function<void(CellColors&)>& add_all) {
  DagAttributes attributes;
  attributes.index = build_cell_index(dag, dag.levels, memory);
  const MemoryReservation index_bytes(memory, attributes.index.view().bytes());
  ValueEncoder encoder(attributes.index.cells, make_value_metric(kColorWeights, 255 * color_bound),
                       memory);
  CellColors cells(dag.levels, encoder);
  add_all(cells);
  cells.finish();
  attributes.colors = encoder.finish();
  attributes.color_errors = encoder.errors();
  return attributes;
}

}  // namespace voxdag
