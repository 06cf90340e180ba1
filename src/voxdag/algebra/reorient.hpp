#pragma once
/// Mirrors and rotates the voxels of a grid.
#include "voxdag/core/orientation.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

/// Returns the orientation that mirrors along an axis, 0 to 2.
Orientation mirrored(int axis);
/// Returns the orientation that rotates about an axis, 0 to 2, by quarter turns. A positive turn
/// takes the next axis to the one after it: about z it takes x to y.
Orientation rotated(int axis, int quarter_turns);
/// Returns the orientation that applies `first`, then `second`.
Orientation then(const Orientation& first, const Orientation& second);

/// Returns the minimal DAG, in canonical order, of the reoriented grid. `dag` must be valid. O(DAG)
/// time. Throws OverMemory and Cancelled.
Svdag reorient(const SvdagView& dag, const Orientation& orientation, Work work = {});

}  // namespace voxdag
