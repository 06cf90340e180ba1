#pragma once
/// Occupancy near a cell, read from any node layout.
#include "voxdag/core/vec.hpp"
#include "voxdag/trace/svdag_nodes.hpp"

namespace voxdag {

/// The mask of the 4³ cells of `level` (2..L) in block `block`, which has side 4 cells and stands
/// at 4 * block: bit i is the cell with Morton code i in the block. Zero outside of the grid.
template <class Nodes>
VOXDAG_HD inline std::uint64_t cell_block(const Nodes& nodes, int level, Vec3i block) {
  const int block_level = level - 2;
  const std::int32_t n = 1 << block_level;
  const auto is_outside = [n](std::int32_t i) { return i < 0 || i >= n; };
  if (nodes.is_empty() || is_outside(block.x) || is_outside(block.y) || is_outside(block.z))
    return 0;
  typename Nodes::Node node = nodes.root();
  for (int at = 0; at < block_level; ++at) {
    const int shift = block_level - 1 - at;
    const int index =
        (block.x >> shift & 1) | (block.y >> shift & 1) << 1 | (block.z >> shift & 1) << 2;
    if ((nodes.child_mask(node, at) >> index & 1u) == 0) return 0;
    node = nodes.child(node, at, index);
  }
  std::uint64_t cells = 0;
  const std::uint32_t mask = nodes.child_mask(node, block_level);
  for (int i = 0; i < 8; ++i) {
    if ((mask >> i & 1u) == 0) continue;
    const auto child = nodes.child(node, block_level, i);
    cells |= std::uint64_t{nodes.child_mask(child, block_level + 1)} << (8 * i);
  }
  return cells;
}

}  // namespace voxdag
