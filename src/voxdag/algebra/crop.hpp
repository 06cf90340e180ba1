#pragma once
/// Keeps the voxels in a box.
#include "voxdag/core/box.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/stored/svdag/long_svdag.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

/// Returns the minimal DAG, in canonical order, of the voxels in `box`: box.lo is in it, box.hi is
/// not. The box may reach beyond the grid. `dag` must be valid. Throws OverMemory and Cancelled.
Svdag crop(const SvdagView& dag, const Box3i& box, Work work = {});
/// Crops a DAG with long pointers. Throws Error if a level of the result has too many nodes for
/// 32-bit pointers, OverMemory and Cancelled.
Svdag crop(const LongSvdagView& dag, const Box3i& box, Work work = {});

}  // namespace voxdag
