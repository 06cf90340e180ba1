#pragma once
/// Places a DAG of any grid in that of an edited one.
#include <optional>

#include "voxdag/core/box.hpp"
#include "voxdag/core/grid.hpp"
#include "voxdag/core/orientation.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

struct StampPlace {
  Orientation orientation{};  ///< Applied first.
  /// The new place of the lower corner of the box of the stamp's voxels, in world units, rounded to
  /// a corner of voxels; by default, its place in the stamp's own grid.
  std::optional<Vec3d> at{};
};

/// A stamp for EditableDag::stamp().
struct PlacedStamp {
  Svdag voxels;  ///< In the grid of the edited DAG.
  Box3i box;     ///< The box of the stamp's voxels. It may reach beyond the grid.
};

/// Returns the voxels of `stamp`, which must be valid. Those outside of `grid` are left out. Throws
/// Error if the voxels of the grids differ in size, by more than 1/1000 of a voxel over the stamp,
/// or if the stamp lies a million voxels or more away; OverMemory and Cancelled.
PlacedStamp place_stamp(const SvdagView& stamp, const Grid& stamp_grid, const StampPlace& place,
                        const Grid& grid, Work work = {});

}  // namespace voxdag
