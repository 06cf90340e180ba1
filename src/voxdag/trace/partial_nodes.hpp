#pragma once
/// Rays at an ESVO with missing blocks, and a node layout that reports the blocks that they miss.
#include "voxdag/stored/esvo/partial_esvo.hpp"
#include "voxdag/trace/esvo_cast.hpp"

namespace voxdag {

/// Returns whether the ray ended at a leaf but would have continued into smaller voxels if there
/// were any.
template <class Stop>
VOXDAG_HD bool would_continue(const EsvoView& esvo, const GridRay& ray, const Stop& stop,
                              const EsvoHit& hit) {
  const ChildDescriptor descriptor = esvo.descriptor(hit.voxel.slot);
  if ((descriptor.leaf_mask() >> hit.voxel.child & 1u) == 0) return false;
  const std::uint32_t corner[3] = {hit.x, hit.y, hit.z};
  float t_exit = ray.plane_t(0, float_from_bits(corner[0]));
  for (int axis = 1; axis < 3; ++axis) {
    const float t = ray.plane_t(axis, float_from_bits(corner[axis]));
    t_exit = t < t_exit ? t : t_exit;
  }
  return !stop(hit.level, hit.t, t_exit);
}

/// Moves the start of a ray to where it met a voxel. The ray meets the same voxels from there on,
/// to the bit.
VOXDAG_HD inline void begin_at(const EsvoHit& hit, GridRay& ray) {
  if (!hit.is_through_contour() || !(hit.t > ray.t_min)) {
    ray.t_min = hit.t;
    return;
  }
  // The ray must start before the contour's plane, or it would not enter through it.
  const float before = float_from_bits(bits_of_float(hit.t) - 1);
  ray.t_min = before > ray.t_min ? before : ray.t_min;
}

/// ContourNodes for the rays of one thread.
class PartialNodes : public ContourNodes {
 public:
  /// Casts set `wanted[block]` to 1 for each block that a ray missed, and then also `has_missed`.
  /// Threads may share `wanted`: all of them store the same value.
  VOXDAG_HD PartialNodes(const PartialEsvoView& esvo, std::uint8_t* wanted, bool& has_missed)
      : ContourNodes(esvo.octree), cut_(esvo.cut), wanted_(wanted), has_missed_(&has_missed) {}

  /// Casts call it for each hit.
  template <class Stop>
  VOXDAG_HD void on_hit(const GridRay& ray, const Stop& stop, const EsvoHit& hit) const {
    if (!would_continue(view(), ray, stop, hit)) return;
    const std::int64_t block = PartialEsvoView{view(), cut_}.missing_block(hit.voxel.slot);
    if (block < 0) return;
    wanted_[block] = 1;
    *has_missed_ = true;
  }

 private:
  const std::uint32_t* cut_;
  std::uint8_t* wanted_;
  bool* has_missed_;
};

}  // namespace voxdag
