#pragma once
/// Decides the contours of cells that are too large to tessellate their displaced surface.
#include <span>

#include "voxdag/esvo/build/decide_cell.hpp"
#include "voxdag/esvo/build/triangle_source.hpp"

namespace voxdag {

/// A cell with more pieces of displaced triangles gets no contour: to fit one takes all of them in
/// memory at once.
inline constexpr std::size_t kMostEnclosed = std::size_t{1} << 16;
/// The bytes that a piece takes in decide_enclosed().
inline constexpr std::uint64_t kEnclosedBytes = sizeof(DisplacedPiece);

/// Decides the contour of a cell from what encloses its `triangles`: pieces of displaced triangles,
/// some of which are an eighth of the cell wide. `shape` is what the ancestors' contours leave of
/// the cell; it is cut by the new contour. Counts the pieces in `memory`; null: no limit. Throws
/// OverMemory.
CellDecision decide_enclosed(const TriangleSource& source, int level, Vec3i cell,
                             std::span<const std::uint32_t> triangles, ConvexPolyhedron& shape,
                             MemoryBudget* memory);

}  // namespace voxdag
