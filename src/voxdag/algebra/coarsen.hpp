#pragma once
/// The DAG of a coarser grid.
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/stored/svdag/long_svdag.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

/// Returns the minimal DAG, in canonical order, of the grid of `levels` levels, from kMinLevels to
/// those of `dag`, in which a voxel is set if its cell in `dag` has voxels. `dag` must be valid.
/// O(DAG) time. Throws OverMemory and Cancelled.
Svdag coarsen(const SvdagView& dag, int levels, Work work = {});
/// Coarsens a DAG with long pointers. Throws Error if a level of the result has too many nodes for
/// 32-bit pointers, OverMemory and Cancelled.
Svdag coarsen(const LongSvdagView& dag, int levels, Work work = {});

}  // namespace voxdag
