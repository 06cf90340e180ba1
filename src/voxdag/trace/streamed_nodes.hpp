#pragma once
/// How walks read an ESVO of which only some blocks are loaded, and say what they miss.
#include "voxdag/trace/esvo_nodes.hpp"

namespace voxdag {

/// Told of what casts end at. Called from many threads at once.
class LeafListener {
 public:
  virtual ~LeafListener() = default;
  /// A ray that would have gone on into smaller voxels ended at a leaf of the descriptor in `slot`.
  virtual void on_leaf(std::uint64_t slot) const = 0;
};

/// ContourNodes that tell a listener of the leaves that rays end at. Host only.
class StreamedNodes : public ContourNodes {
 public:
  StreamedNodes(const EsvoView& esvo, const LeafListener& listener)
      : ContourNodes(esvo), listener_(&listener) {}

  void on_leaf(std::uint64_t slot) const { listener_->on_leaf(slot); }

 private:
  const LeafListener* listener_;
};

}  // namespace voxdag
