#pragma once
/// Voxels in any of the forms that files hold, for what casts rays at all of them.
#include "voxdag/layout/voxel_set.hpp"
#include "voxdag/trace/esvo_cast.hpp"
#include "voxdag/trace/svdag_nodes.hpp"

namespace voxdag {

/// A view of either: points to what it was made from. Host only.
class VoxelScene : public VoxelSet {
 public:
  using VoxelSet::VoxelSet;

  /// Returns body(nodes), nodes being the layout that rays are cast at: SvdagNodes or ContourNodes.
  template <class Body>
  auto visit_nodes(const Body& body) const {
    if (const EsvoView* octree = esvo()) return body(ContourNodes(*octree));
    return body(SvdagNodes(*dag()));
  }
};

}  // namespace voxdag
