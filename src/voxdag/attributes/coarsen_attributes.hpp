#pragma once
/// The attributes of a coarser grid.
#include "voxdag/attributes/build_attributes.hpp"

namespace voxdag {

/// Returns the attributes of `coarse`, the DAG that coarsen() made of `fine`. Each cell keeps its
/// values exactly: those that the encoder stored for this inner cell of the fine grid. If the
/// finest level with attributes is a level of the coarse grid, the bytes of all values stay. Finer
/// values are dropped, and the others are encoded again without loss. The result's errors are not
/// set. Runs on the current TBB arena. The budget no longer counts the result when the function
/// returns. Throws OverMemory and Cancelled; `memory` and `progress` may be null.
DagAttributes coarsen_attributes(const ColoredDagView& fine, const SvdagView& coarse,
                                 MemoryBudget* memory = nullptr, Progress* progress = nullptr);

}  // namespace voxdag
