#pragma once
/// The ray cast of cast.hpp at the paper's layout: the same cells for every ray, to the bit, in
/// fewer instructions, which are what limits GPUs. The stack holds child masks, and a walk reads a
/// leaf block once.
#include "voxdag/trace/cast.hpp"
#include "voxdag/trace/svdag_nodes.hpp"

namespace voxdag {

/// Casts a ray like cast() in cast.hpp.
template <class Stop>
VOXDAG_HD inline bool cast(const SvdagNodes& layout, const GridRay& ray, const Stop& stop,
                           CellHit& hit) {
  if (ray.misses() || layout.is_empty()) return false;
  float t = ray.t_min;
  if (ray.exit_t() <= t) return false;

  struct Parent {
    std::uint32_t node, mask;
  };
  Parent stack[kMaxLevels];
  const std::uint32_t* const nodes = layout.view().nodes;
  const std::uint64_t* const leaf_blocks = layout.view().leaf_blocks;
  const int octant_bit = 24 - layout.levels();  // the position bit of cells in a leaf block
  const std::uint32_t mirrored = ray.mirrored;
  std::uint32_t node = layout.root();
  std::uint32_t mask = layout.child_mask(node, 0);
  // The last leaf block that the walk was in.
  std::uint64_t block = layout.levels() == kMinLevels ? leaf_blocks[node] : 0;
  std::uint32_t block_mask = mask;
  CellWalk cell(ray, t);
  for (;;) {
    const CellWalk::Exit exit = cell.exit();
    const std::uint32_t index = cell.child() ^ mirrored;
    const int bit = cell.bit();
    if ((mask >> index & 1u) != 0) {
      if (bit < octant_bit || stop(cell.level(), t, exit.t)) {
        hit = {t, cell.x(), cell.y(), cell.z(), cell.level()};
        return true;
      }
      if (bit == octant_bit) {
        mask = static_cast<std::uint32_t>(block >> (8 * index)) & 0xFFu;
      } else {
        stack[cell.level() - 1] = {node, mask};
        node = nodes[node + 1 + popcount8(mask & ((1u << index) - 1u))];
        if (bit == octant_bit + 1) {
          block = leaf_blocks[node];
          mask = block_mask = leaf_block_child_mask(block);
        } else {
          mask = child_mask(nodes + node);
        }
      }
      cell.push(t);
      continue;
    }
    if (exit.t > ray.t_max) return false;
    t = exit.t;
    if (cell.advance(exit)) continue;
    if (!cell.pop()) return false;
    if (cell.bit() == octant_bit) {
      mask = block_mask;  // the walk was in a byte of the block
    } else {
      const Parent parent = stack[cell.level() - 1];
      node = parent.node;
      mask = parent.mask;
    }
  }
}

}  // namespace voxdag
