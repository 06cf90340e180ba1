#pragma once
/// Point queries on an ESVO.
#include "voxdag/core/morton.hpp"
#include "voxdag/stored/esvo/esvo.hpp"

namespace voxdag {

/// Sets `found` to the finest voxel of level 1 to `level` that holds the cell `cell` of `level`.
/// The octree's grid may have more or fewer levels. Returns false if there is no such voxel.
VOXDAG_HD inline bool find_esvo_voxel(const EsvoView& esvo, Vec3i cell, int level,
                                      EsvoVoxel& found) {
  if (esvo.is_empty()) return false;
  std::uint64_t slot = esvo.root;
  for (int depth = 1; depth <= level; ++depth) {
    const ChildDescriptor descriptor = esvo.descriptor(slot);
    const int child = child_index(cell, level - depth);
    if ((descriptor.valid_mask() >> child & 1u) == 0) return depth > 1;
    found = {slot, child};
    if ((descriptor.leaf_mask() >> child & 1u) != 0) return true;
    slot = esvo.child(slot, descriptor, child);
  }
  return level > 0;
}

}  // namespace voxdag
