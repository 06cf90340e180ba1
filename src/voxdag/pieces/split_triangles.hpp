#pragma once
/// Finds the children of a cell that its triangles may meet.
#include <cstdint>
#include <span>

#include "voxdag/pieces/child_triangles.hpp"
#include "voxdag/pieces/triangle_source.hpp"

namespace voxdag {

/// Lists for each child of the cell the triangles that may meet it. The lists are exact for
/// triangles that are not displaced. It is used for cells with displaced triangles, or with too
/// many triangles to load them all. Runs in parallel. Counts the lists in `memory`; null: no limit.
/// Throws OverMemory.
ChildTriangles split_triangles(const TriangleSource& source, int level, Vec3i cell,
                               std::span<const std::uint32_t> triangles, MemoryBudget* memory);

}  // namespace voxdag
