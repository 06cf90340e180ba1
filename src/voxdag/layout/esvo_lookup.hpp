#pragma once
/// Point queries on an ESVO.
#include "voxdag/core/morton.hpp"
#include "voxdag/layout/esvo.hpp"

namespace voxdag {

/// The voxel of `level` in [1, L] that holds `voxel`, one of the finest level in coordinates of the
/// grid. There must be one, as where a ray hit: all above it are no leaves.
VOXDAG_HD inline EsvoVoxel esvo_voxel_at(const EsvoView& esvo, Vec3i voxel, int level) {
  std::uint64_t slot = esvo.root;
  for (int l = 1;; ++l) {
    const int child = child_index(voxel, esvo.levels - l);
    if (l == level) return {slot, child};
    slot = esvo.child(slot, esvo.descriptor(slot), child);
  }
}

}  // namespace voxdag
