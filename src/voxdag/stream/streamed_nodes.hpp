#pragma once
/// The node layout for rays at an ESVO with only some blocks loaded. It reports the leaves where
/// blocks are missing.
#include <algorithm>

#include "voxdag/trace/esvo_cast.hpp"

namespace voxdag {

/// Receives the leaves at which casts end. Many threads call it concurrently.
class LeafListener {
 public:
  virtual ~LeafListener() = default;
  /// Called when a ray that would have continued into smaller voxels ended at a leaf of the
  /// descriptor in `slot`.
  virtual void on_leaf(std::uint64_t slot) const = 0;
};

/// Returns whether the ray ended at a leaf but would have continued into smaller voxels if there
/// were any.
template <class Stop>
bool would_continue(const EsvoView& esvo, const GridRay& ray, const Stop& stop,
                    const EsvoHit& hit) {
  const ChildDescriptor descriptor = esvo.descriptor(hit.voxel.slot);
  if ((descriptor.leaf_mask() >> hit.voxel.child & 1u) == 0) return false;
  const float x = ray.plane_t(0, float_from_bits(hit.x)),
              y = ray.plane_t(1, float_from_bits(hit.y)),
              z = ray.plane_t(2, float_from_bits(hit.z));
  return !stop(hit.level, hit.t, std::min({x, y, z}));
}

/// ContourNodes that report the leaves at which rays end to a listener. Host only.
class StreamedNodes : public ContourNodes {
 public:
  StreamedNodes(const EsvoView& esvo, const LeafListener& listener)
      : ContourNodes(esvo), listener_(&listener) {}

  /// Reports a hit; casters call it for each hit, with the stop of the cast.
  template <class Stop>
  void on_hit(const GridRay& ray, const Stop& stop, const EsvoHit& hit) const {
    if (would_continue(view(), ray, stop, hit)) listener_->on_leaf(hit.voxel.slot);
  }

 private:
  const LeafListener* listener_;
};

}  // namespace voxdag
