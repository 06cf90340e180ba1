#pragma once
/// Fits grids of normals to normals by least squares.
#include "voxdag/esvo/encode/normal_grid.hpp"

namespace voxdag {

/// Returns `grid` with its base moved to fit the normals that `points` assigns to its points.
RealGrid settled_grid(const NormalValues& values, const NormalFit& points, RealGrid grid);

/// Returns whether the base is too short to have a direction.
inline bool is_lost(const RealGrid& grid) { return !(longest_side(grid.base) > 0.1f); }

/// Repeats three steps while that helps, at most `rounds` times: fits the grid to the normals, with
/// the points that `start` assigns to them (only its coefficients matter); rounds it to its stored
/// form; assigns the nearest points. Replaces `best` if the result is better.
void consider_grid(const NormalValues& values, const RealGrid& grid, const NormalFit& start,
                   int rounds, NormalFit& best);

/// Does the same, starting with the grid points nearest to the normals.
void consider_grid(const NormalValues& values, const RealGrid& grid, int rounds, NormalFit& best);

}  // namespace voxdag
