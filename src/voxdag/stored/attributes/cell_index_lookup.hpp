#pragma once
/// Finds the numbers of cells by their places.
#include "voxdag/core/morton.hpp"
#include "voxdag/stored/attributes/cell_index.hpp"

namespace voxdag {

/// Returns the distance from the number of the node at word `node` of `level` to the number of its
/// child `child`, which must exist. `level` must be coarser than the finest level with attributes.
VOXDAG_HD inline std::uint64_t child_distance(const SvdagView& dag, const CellIndexView& index,
                                              int level, std::uint64_t node, int child) {
  const int before = popcount8(child_mask(dag.nodes + node) & ((1u << child) - 1u));
  if (before == 0) return 1;
  // Each child is a cell of the finest level: its subtree is one cell.
  if (!has_cell_sums(dag, level, index.finest_level)) return static_cast<std::uint64_t>(1 + before);
  return cell_sum(dag, index, level, node + static_cast<std::uint64_t>(before));
}

/// Sets `number` to the number of the cell `cell` of `level`, 0 to L. If the level is finer than
/// the finest with attributes, m, takes the number of the cell's ancestor of level m. Returns false
/// if the cell has no voxels or is outside the grid. Time in O(level): one walk from the root reads
/// one slot per level and no sibling.
VOXDAG_HD inline bool find_cell_number(const SvdagView& dag, const CellIndexView& index, Vec3i cell,
                                       int level, std::uint64_t& number) {
  if (dag.is_empty() || (cell.x | cell.y | cell.z) >> level != 0) return false;
  const int last = level < index.finest_level ? level : static_cast<int>(index.finest_level);
  std::uint32_t at = 0;
  std::uint64_t sum = 0;
  for (int l = 0; l < level; ++l) {
    const int child = child_index(cell, level - 1 - l);
    if (l < dag.levels - 2) {
      const std::uint32_t* node = dag.nodes + at;
      if ((child_mask(node) >> child & 1u) == 0) return false;
      if (l < last) sum += child_distance(dag, index, l, at, child);
      at = child_pointer(node, child);
      continue;
    }
    // Inside a leaf block: first an octant of 2³ voxels, then one voxel of it.
    const std::uint64_t block = dag.leaf_blocks[at];
    const auto octant = static_cast<std::uint32_t>(block >> (8 * child) & 0xFF);
    if (octant == 0) return false;
    if (l < last) sum += octant_distance(block, child, dag.levels, index.finest_level);
    if (level == dag.levels) {
      const int voxel = child_index(cell, 0);
      if ((octant >> voxel & 1u) == 0) return false;
      if (last == dag.levels)
        sum += 1 + static_cast<std::uint64_t>(popcount8(octant & ((1u << voxel) - 1u)));
    }
    break;
  }
  number = sum;
  return true;
}

}  // namespace voxdag
