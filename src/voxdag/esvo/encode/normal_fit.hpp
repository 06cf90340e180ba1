#pragma once
/// Grids of normals, fitted to the normals by least squares.
#include "voxdag/esvo/encode/normal_grid.hpp"

namespace voxdag {

/// `grid` with its base where its points lie best for the normals that `points` gives them.
RealGrid settled_grid(const NormalValues& values, const NormalFit& points, RealGrid grid);

/// Too near to zero to have a direction.
inline bool is_lost(const RealGrid& grid) { return !(longest_side(grid.base) > 0.1f); }

/// Fits the grid to the points that `start` has, stores it, gives its points to the normals anew,
/// and so on while that helps, `rounds` times at most; takes the result if it is better than the
/// best so far. Of `start` the coefficients alone matter.
void consider_grid(const NormalValues& values, const RealGrid& grid, const NormalFit& start,
                   int rounds, NormalFit& best);

/// The same, beginning with the points of the grid nearest to the normals.
void consider_grid(const NormalValues& values, const RealGrid& grid, int rounds, NormalFit& best);

}  // namespace voxdag
