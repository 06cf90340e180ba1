#pragma once
/// Builds the DAG of a part of a grid.
#include "voxdag/builders/voxelize/cell_range.hpp"
#include "voxdag/builders/voxelize/grid_mapping.hpp"
#include "voxdag/core/memory_budget.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

/// Returns the minimal DAG, in canonical order, of those voxels that lie in `range` and meet a
/// triangle. It is a DAG of the whole grid of 2^levels voxels a side, without voxels elsewhere.
/// `range` is of level `levels` - 2 or coarser. `triangles` are used up. `work` counts the memory
/// of the build, and not the result. Runs on the current TBB arena. Throws OverMemory, Error if the
/// DAG outgrows 32-bit pointers, and Cancelled.
Svdag build_range(CountedVector<QuantizedTriangle> triangles, int levels, const CellRange& range,
                  Work work = {});

}  // namespace voxdag
