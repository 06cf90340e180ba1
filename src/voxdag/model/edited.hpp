#pragma once
/// Models that were made from other models.
#include <string>

#include "voxdag/model/dag_model.hpp"

namespace voxdag {

/// Returns a model of `dag` in `grid`, without attributes. Its metadata are those of `source`;
/// their entry "edits" gets `edit`, which says how the voxels were made. Throws OverMemory.
DagModel edited(const DagModel& source, Svdag dag, const Grid& grid, const std::string& edit,
                MemoryBudget* memory = nullptr);

}  // namespace voxdag
