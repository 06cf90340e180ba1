#pragma once
/// Reads the occupancy of the cells around a point from any node layout.
#include "voxdag/core/bits.hpp"
#include "voxdag/core/morton.hpp"
#include "voxdag/core/vec.hpp"

namespace voxdag {

/// The cells of eight neighbouring blocks of 4³ cells: 2 by 2 by 2, so 8³ cells of one level.
struct CellBlocks {
  /// masks[x | y << 1 | z << 2] belongs to block (x, y, z): bit i is the cell with Morton code i.
  std::uint64_t masks[8] = {};
};

/// Returns the mask of the 4³ cells two levels below `node`, whose level is `level` <= L-2.
template <class Nodes>
VOXDAG_HD inline std::uint64_t cell_mask(const Nodes& nodes, typename Nodes::Node node, int level) {
  std::uint64_t cells = 0;
  const std::uint32_t mask = nodes.child_mask(node, level);
  for (int i = 0; i < 8; ++i) {
    if ((mask >> i & 1u) == 0) continue;
    const auto child = nodes.child(node, level, i);
    cells |= std::uint64_t{nodes.child_mask(child, level + 1)} << (8 * i);
  }
  return cells;
}

/// Moves `node` from its level `from_level` down to the node of `to_level` at `cell`, in cells of
/// `to_level`. Returns false if there is no such node.
template <class Nodes>
VOXDAG_HD inline bool descend(const Nodes& nodes, typename Nodes::Node& node, int from_level,
                              int to_level, Vec3i cell) {
  for (int level = from_level; level < to_level; ++level) {
    const int shift = to_level - 1 - level;
    const int index = child_index(cell, shift);
    if ((nodes.child_mask(node, level) >> index & 1u) == 0) return false;
    node = nodes.child(node, level, index);
  }
  return true;
}

/// Returns the cells of `level` (2..L) in the blocks `block` to `block` + 1 on every axis; block b
/// begins at cell 4b. Cells outside the grid are empty. Walks down once to the finest node that
/// holds all blocks, then once to each block.
template <class Nodes>
VOXDAG_HD inline CellBlocks cell_blocks(const Nodes& nodes, int level, Vec3i block) {
  CellBlocks blocks;
  if (nodes.is_empty()) return blocks;
  const int block_level = level - 2;
  const std::int32_t last = (1 << block_level) - 1;
  const Vec3i lo = max(block, Vec3i{0, 0, 0}), hi = min(block + Vec3i{1, 1, 1}, {last, last, last});
  if (lo.x > hi.x || lo.y > hi.y || lo.z > hi.z) return blocks;
  const std::int32_t apart = (lo.x ^ hi.x) | (lo.y ^ hi.y) | (lo.z ^ hi.z);
  const int up = apart == 0 ? 0 : highest_bit(static_cast<std::uint32_t>(apart)) + 1;
  const int common_level = block_level - up;
  typename Nodes::Node common = nodes.root();
  if (!descend(nodes, common, 0, common_level, {lo.x >> up, lo.y >> up, lo.z >> up})) return blocks;
  for (int z = lo.z; z <= hi.z; ++z)
    for (int y = lo.y; y <= hi.y; ++y)
      for (int x = lo.x; x <= hi.x; ++x) {
        typename Nodes::Node node = common;
        if (!descend(nodes, node, common_level, block_level, {x, y, z})) continue;
        blocks.masks[(x - block.x) | (y - block.y) << 1 | (z - block.z) << 2] =
            cell_mask(nodes, node, block_level);
      }
  return blocks;
}

}  // namespace voxdag
