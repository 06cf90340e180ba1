#pragma once
/// The outermost voxels of a DAG along an axis.
#include <cstdint>
#include <vector>

#include "voxdag/core/parallel/work.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

/// Which end of the axis the voxels are seen from.
enum class HeightSide { kHigh, kLow };

/// Returns, for each column of voxels along `axis` (0, 1 or 2), the coordinate of the voxel nearest
/// to that end of the axis; -1 if the column has no voxels. Column (u, v) is value u + N v, where u
/// is the first of the other two axes in the order x, y, z, and v the second. Visits the nodes that
/// can be seen. Throws Cancelled.
std::vector<std::int32_t> height_map(const SvdagView& dag, int axis, HeightSide side, Work work);

}  // namespace voxdag
