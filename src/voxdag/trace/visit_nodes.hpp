#pragma once
/// Chooses the node layout for rays at voxels of either kind, DAG or ESVO.
#include "voxdag/stored/svdag/voxel_set.hpp"
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
