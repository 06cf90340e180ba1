#pragma once
/// The node layout that rays are cast at, for voxels in any of the forms that files hold.
#include "voxdag/layout/voxel_set.hpp"
#include "voxdag/trace/esvo_cast.hpp"
#include "voxdag/trace/svdag_nodes.hpp"

namespace voxdag {

/// Calls body(nodes) with SvdagNodes of a DAG or ContourNodes of an ESVO and returns its result.
/// Host only.
template <class Body>
auto visit_nodes(const VoxelSet& voxels, const Body& body) {
  if (const EsvoView* octree = voxels.esvo()) return body(ContourNodes(*octree));
  return body(SvdagNodes(*voxels.dag()));
}

}  // namespace voxdag
