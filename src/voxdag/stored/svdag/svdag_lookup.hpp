#pragma once
/// Point queries on a DAG.
#include "voxdag/core/morton.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

/// Returns the mask of the leaf block that holds `voxel`; 0 if that block has no voxels or is
/// outside the grid.
VOXDAG_HD inline std::uint64_t leaf_block_at(const SvdagView& dag, Vec3i voxel) {
  const auto outside = [&](std::int32_t c) { return c < 0 || c >> dag.levels != 0; };
  if (dag.is_empty() || outside(voxel.x) || outside(voxel.y) || outside(voxel.z)) return 0;
  std::uint32_t at = dag.root;
  for (int level = 0; level < dag.levels - 2; ++level) {
    const int shift = dag.levels - level - 1;
    const int child = child_index(voxel, shift);
    const std::uint32_t* node = dag.nodes + at;
    if ((child_mask(node) >> child & 1) == 0) return 0;
    at = child_pointer(node, child);
  }
  return dag.leaf_blocks[at];
}

/// Returns whether `cell` of `level` in [0, L] contains a voxel that is set. A cell of that level
/// has 2^(L-level) voxels a side, and coordinates in [0, 2^level). Returns false outside the grid.
VOXDAG_HD inline bool svdag_contains(const SvdagView& dag, Vec3i cell, int level) {
  if (dag.is_empty() || (cell.x | cell.y | cell.z) >> level != 0) return false;
  std::uint32_t at = dag.root;
  for (int l = 0; l < level; ++l) {
    const int shift = level - 1 - l;
    const int child = child_index(cell, shift);
    if (l < dag.levels - 2) {
      const std::uint32_t* node = dag.nodes + at;
      if (((child_mask(node) >> child) & 1) == 0) return false;
      at = child_pointer(node, child);
      continue;
    }
    // Inside a leaf block: first an octant of 2³ voxels, then one voxel of it.
    const std::uint64_t octant = (dag.leaf_blocks[at] >> (8 * child)) & 0xFF;
    if (level == dag.levels - 1) return octant != 0;
    const int voxel = child_index(cell, 0);
    return ((octant >> voxel) & 1) != 0;
  }
  return true;
}

}  // namespace voxdag
