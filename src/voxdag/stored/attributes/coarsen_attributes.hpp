#pragma once
/// The attributes of a coarser grid.
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/stored/attributes/dag_attributes.hpp"

namespace voxdag {

/// The largest changes of values that are encoded again, in the units of AttributeOptions. 0: the
/// values do not change.
struct CoarsenBounds {
  double color_bound = 0;
  double normal_bound_degrees = 0;  ///< Below kMinNormalBound, normals do not change.
};

/// Returns the attributes of `coarse`, the DAG that coarsen() made of `fine`. Each cell keeps its
/// values: those that the encoder stored for this inner cell of the fine grid. If the finest level
/// with attributes is a level of the coarse grid, the bytes of all values stay. Otherwise finer
/// values are dropped, and the others are encoded again within `bounds`, materials without loss.
/// The result's errors are not set. Runs on the current TBB arena. The budget no longer counts the
/// result when the function returns. Throws OverMemory and Cancelled.
DagAttributes coarsen_attributes(const ColoredDagView& fine, const SvdagView& coarse,
                                 const CoarsenBounds& bounds = {}, Work work = {});

}  // namespace voxdag
