#pragma once
/// Walks the cells of a DAG with their numbers.
#include "voxdag/stored/attributes/cell_index_lookup.hpp"

namespace voxdag {

/// A cell of the octree that a DAG represents.
struct NumberedCell {
  int level = 0;
  /// At levels above L-2, the node's first word; at level L-2, the index of the leaf block.
  std::uint32_t at = 0;
  std::uint64_t number = 0;
  /// At level L-1, the bit mask of the octant's eight voxels.
  std::uint32_t octant = 0;
};

/// Returns the child mask of a cell of a level from 0 to L-1.
VOXDAG_HD inline std::uint32_t children_of(const SvdagView& dag, const NumberedCell& cell) {
  if (cell.level < dag.levels - 2) return child_mask(dag.nodes + cell.at);
  if (cell.level == dag.levels - 2) return leaf_block_child_mask(dag.leaf_blocks[cell.at]);
  return cell.octant;
}

/// Returns the child `child`, which must exist, of a cell. The cell's level must be coarser than
/// the finest level with attributes.
VOXDAG_HD inline NumberedCell child_of(const SvdagView& dag, const CellIndexView& index,
                                       const NumberedCell& cell, int child) {
  NumberedCell result;
  result.level = cell.level + 1;
  if (cell.level < dag.levels - 2) {
    result.at = child_pointer(dag.nodes + cell.at, child);
    result.number = cell.number + child_distance(dag, index, cell.level, cell.at, child);
  } else if (cell.level == dag.levels - 2) {
    const std::uint64_t block = dag.leaf_blocks[cell.at];
    result.octant = static_cast<std::uint32_t>(block >> (8 * child) & 0xFF);
    result.number = cell.number + octant_distance(block, child, dag.levels, index.finest_level);
  } else {
    const std::uint32_t before = cell.octant & ((1u << child) - 1u);
    result.number = cell.number + 1 + static_cast<std::uint64_t>(popcount8(before));
  }
  return result;
}

/// Returns the number of cells in the subtree of a cell of a level from 0 to m, itself included.
VOXDAG_HD inline std::uint64_t cells_in(const SvdagView& dag, const CellIndexView& index,
                                        const NumberedCell& cell) {
  if (cell.level == index.finest_level) return 1;
  if (cell.level == dag.levels - 2)
    return leaf_block_cells(dag.leaf_blocks[cell.at], dag.levels, index.finest_level);
  const auto children = static_cast<std::uint64_t>(popcount8(children_of(dag, cell)));
  return has_cell_sums(dag, cell.level, index.finest_level)
             ? cell_sum(dag, index, cell.level, cell.at + children)
             : 1 + children;
}

}  // namespace voxdag
