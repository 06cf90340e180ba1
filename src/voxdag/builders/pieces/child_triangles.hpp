#pragma once
/// Lists of the triangles that meet the children of a cell.
#include <array>
#include <cstdint>

#include "voxdag/core/memory_budget.hpp"

namespace voxdag {

/// Indices of triangles, counted in a budget.
using TriangleList = CountedVector<std::uint32_t>;

/// The triangles of each child of a cell, in the order of the cell's.
using ChildTriangles = std::array<TriangleList, 8>;

inline ChildTriangles empty_children(MemoryBudget* budget) {
  const TriangleList none(budget);
  return {none, none, none, none, none, none, none, none};
}

}  // namespace voxdag
