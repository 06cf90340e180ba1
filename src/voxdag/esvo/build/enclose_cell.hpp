#pragma once
/// Contours of cells that are too large to tessellate their displaced surface.
#include <span>

#include "voxdag/esvo/build/decide_cell.hpp"
#include "voxdag/esvo/build/triangle_source.hpp"

namespace voxdag {

/// Decides the contour of a cell from what encloses its `triangles`: pieces of displaced triangles,
/// some of which are an eighth of the cell wide. `shape` is what the ancestors' contours leave of
/// the cell; it is cut by the new contour.
CellDecision decide_enclosed(const TriangleSource& source, int level, Vec3i cell,
                             std::span<const std::uint32_t> triangles, ConvexPolyhedron& shape);

}  // namespace voxdag
