#pragma once
/// The node layout for rays at an ESVO with only some blocks loaded. It reports the leaves where
/// blocks are missing.
#include "voxdag/trace/partial_nodes.hpp"

namespace voxdag {

/// Receives the leaves at which casts end. Many threads call it concurrently.
class LeafListener {
 public:
  virtual ~LeafListener() = default;
  /// Called when a ray that would have continued into smaller voxels ended at a leaf of the
  /// descriptor in `slot`.
  virtual void on_leaf(std::uint64_t slot) const = 0;
};

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
