#pragma once
/// Lists the triangles that may meet the grid, and those that may meet the children of a cell.
#include <cstdint>
#include <span>

#include "voxdag/builders/pieces/child_triangles.hpp"
#include "voxdag/builders/pieces/triangle_source.hpp"

namespace voxdag {

/// Lists the triangles that may meet the grid, without duplicates. A triangle that is not displaced
/// is listed if its box meets the grid. Counts the list in `memory`. Throws OverMemory.
TriangleList triangles_of_grid(const TriangleSource& source, MemoryBudget* memory);

/// Lists for each child of the cell the triangles that may meet it. The lists are exact for
/// triangles that are not displaced. `triangles` must be from triangles_of_grid(). Builders call it
/// for cells with displaced triangles, and for cells with too many triangles to load them all. Runs
/// in parallel. Counts the lists in `memory`. Throws OverMemory.
ChildTriangles split_triangles(const TriangleSource& source, int level, Vec3i cell,
                               std::span<const std::uint32_t> triangles, MemoryBudget* memory);

}  // namespace voxdag
