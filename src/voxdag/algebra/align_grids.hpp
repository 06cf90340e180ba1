#pragma once
/// Finds a grid that holds the voxels of two others.
#include "voxdag/core/grid.hpp"

namespace voxdag {

/// Two grids in a common one. Voxel p of the first is voxel p + first of the common grid.
struct AlignedGrids {
  Grid grid;
  Vec3i first, second;
};

/// Returns the smallest grid that starts at the lower corner of both grids and holds both; the
/// first one itself if it holds the second. Throws Error with the reason if their voxels have
/// different sizes or do not coincide, by more than 1/1000 of a voxel anywhere, or if the common
/// grid would have more than kMaxLevels levels.
AlignedGrids align_grids(const Grid& first, const Grid& second);

}  // namespace voxdag
