#pragma once
/// Contours of cells whose displaced surface is not tessellated.
#include <span>

#include "voxdag/esvo/build/cell_builder.hpp"
#include "voxdag/esvo/build/triangle_source.hpp"

namespace voxdag {

/// The contour of a cell with `triangles`, fitted to what encloses their pieces, some of which are
/// an eighth of the cell wide. `shape` is what the ancestors' contours leave of it; becomes what
/// its own leaves.
VoxelDecision decide_enclosed(const TriangleSource& source, int level, Vec3i cell,
                              std::span<const std::uint32_t> triangles, ConvexPolyhedron& shape);

}  // namespace voxdag
