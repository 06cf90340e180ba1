#pragma once
/// Whether places are inside a closed mesh, in exact integers.
#include <vector>

#include "voxdag/builders/voxelize/grid_mapping.hpp"
#include "voxdag/core/parallel/work.hpp"

namespace voxdag {

/// Returns for each voxel whether the ray from its centre along +x crosses an odd number of
/// triangles. A centre in a triangle lies on one of its sides, the same for all triangles of a
/// surface. All triangles count, also exact duplicates.
///
/// Exact: the ray lies beside the centre by infinitely small steps in y and, much smaller, in z. So
/// it meets no edge, and each edge that lies in its way counts to exactly one side. (Edelsbrunner
/// and Mücke, "Simulation of Simplicity", ACM TOG 1990.) Time grows with the triangles, and with
/// the voxels that lie behind each of them along x. Throws Cancelled.
std::vector<bool> are_inside(const QuantizedMesh& mesh, const std::vector<Vec3i>& voxels,
                             Work work);

}  // namespace voxdag
