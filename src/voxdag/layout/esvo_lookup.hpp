#pragma once
/// Point queries on an ESVO.
#include "voxdag/core/morton.hpp"
#include "voxdag/layout/esvo.hpp"

namespace voxdag {

/// Returns the voxel of `level` in [1, L] that holds the voxel of the finest level at `voxel`. It
/// must exist, as it does at a ray's hit, and none of its ancestors may be a leaf.
VOXDAG_HD inline EsvoVoxel esvo_voxel_at(const EsvoView& esvo, Vec3i voxel, int level) {
  std::uint64_t slot = esvo.root;
  for (int l = 1;; ++l) {
    const int child = child_index(voxel, esvo.levels - l);
    if (l == level) return {slot, child};
    slot = esvo.child(slot, esvo.descriptor(slot), child);
  }
}

}  // namespace voxdag
