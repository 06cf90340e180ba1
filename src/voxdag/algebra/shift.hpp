#pragma once
/// Moves voxels in their grid.
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/core/vec.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

/// Returns the minimal DAG, in canonical order, of the grid of `levels` levels in which voxel p +
/// `offset` is set if voxel p of `dag` is set. Voxels that would lie outside the grid are left out.
/// `levels` may be more or less than the DAG's. `dag` must be valid. Each different cell depends on
/// up to eight nodes. Throws Error if the result outgrows 32-bit pointers, OverMemory and
/// Cancelled.
Svdag shift(const SvdagView& dag, Vec3i offset, int levels, Work work = {});

}  // namespace voxdag
