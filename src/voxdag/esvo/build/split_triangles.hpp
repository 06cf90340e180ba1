#pragma once
/// Which children of a cell its triangles may meet.
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "voxdag/esvo/build/triangle_source.hpp"

namespace voxdag {

/// The triangles of each child of a cell, in the order of the cell's.
using ChildTriangles = std::array<std::vector<std::uint32_t>, 8>;

/// Lists the triangles that each child of the cell may meet: exactly those that meet it where they
/// are not displaced. For cells whose triangles are too many, or displaced, to load them all. Runs
/// in parallel.
ChildTriangles split_triangles(const TriangleSource& source, int level, Vec3i cell,
                               std::span<const std::uint32_t> triangles);

}  // namespace voxdag
