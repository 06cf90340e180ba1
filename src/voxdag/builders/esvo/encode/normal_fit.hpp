#pragma once
/// Fits grids to normals by least squares.
#include "voxdag/builders/esvo/encode/normal_grid.hpp"

namespace voxdag {

/// Returns `grid` with its base moved so that its points best fit the normals assigned to them.
RealGrid settled_grid(const NormalValues& values, const NormalFit& points, RealGrid grid);

/// Returns whether the base of a grid is too short to have a direction.
inline bool is_lost(const RealGrid& grid) { return !(longest_side(grid.base) > 0.1f); }

/// Fits the grid to the points that `start` assigns, rounds it to its stored form and assigns the
/// points again. Repeats that while the error decreases, at most `rounds` times. Replaces `best` if
/// the result is better. Uses only the coefficients of `start`.
void consider_grid(const NormalValues& values, const RealGrid& grid, const NormalFit& start,
                   int rounds, NormalFit& best);

/// Calls the function above, starting with the grid points nearest to the normals.
void consider_grid(const NormalValues& values, const RealGrid& grid, int rounds, NormalFit& best);

}  // namespace voxdag
