#pragma once
/// Fits grids to normals by least squares.
#include "voxdag/esvo/encode/normal_grid.hpp"

namespace voxdag {

/// Returns `grid` with the base moved to where its points best fit the normals assigned to them.
RealGrid settled_grid(const NormalValues& values, const NormalFit& points, RealGrid grid);

/// Vectors shorter than this count as having no direction.
inline bool is_lost(const RealGrid& grid) { return !(longest_side(grid.base) > 0.1f); }

/// Fits the grid to the points that `start` assigns, stores it, assigns the points again, and
/// repeats that while it helps, at most `rounds` times. Keeps the result if it is better than the
/// best so far. Only the coefficients of `start` matter.
void consider_grid(const NormalValues& values, const RealGrid& grid, const NormalFit& start,
                   int rounds, NormalFit& best);

/// Does the same, starting with the grid points nearest to the normals.
void consider_grid(const NormalValues& values, const RealGrid& grid, int rounds, NormalFit& best);

}  // namespace voxdag
