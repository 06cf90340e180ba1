#pragma once
/// Models that were made from other models.
#include <string>
#include <utility>

#include "voxdag/file/model/dag_model.hpp"

namespace voxdag {

/// Returns a model of `dag` in `grid`, without attributes and home view. The metadata are `source`;
/// their entry "edits" gets `edit`, which says how the voxels were made. Throws OverMemory.
DagModel edited(const VdagMetadata& source, Svdag dag, const Grid& grid, const std::string& edit,
                Work work = {});
inline DagModel edited(const DagModel& source, Svdag dag, const Grid& grid, const std::string& edit,
                       Work work = {}) {
  return edited(source.metadata(), std::move(dag), grid, edit, work);
}

}  // namespace voxdag
