#pragma once
/// Which children of a cell its triangles may meet.
#include <cstdint>
#include <span>

#include "voxdag/esvo/build/child_triangles.hpp"
#include "voxdag/esvo/build/triangle_source.hpp"

namespace voxdag {

/// Lists the triangles that each child of the cell may meet: exactly those that meet it where they
/// are not displaced. For cells whose triangles are too many, or displaced, to load them all. Runs
/// in parallel. Counts the lists in `memory`; null: no limit. Throws OverMemory.
ChildTriangles split_triangles(const TriangleSource& source, int level, Vec3i cell,
                               std::span<const std::uint32_t> triangles, MemoryBudget* memory);

}  // namespace voxdag
