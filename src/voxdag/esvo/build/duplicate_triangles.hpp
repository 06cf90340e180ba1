#pragma once
/// Which triangles of a mesh repeat others exactly.
#include <cstdint>
#include <vector>

#include "voxdag/core/memory_budget.hpp"
#include "voxdag/mesh/appearance.hpp"
#include "voxdag/mesh/mesh.hpp"
#include "voxdag/parallel/progress.hpp"

namespace voxdag {

/// Returns for each triangle 1 if an earlier one has the same corners, in the same direction of
/// rotation, with the same appearance: the material and, by corner, normals, texture coordinates
/// and colours. Without `appearance` (null) only the positions are compared. Empty if no triangle
/// is a duplicate. Counts 8 bytes per triangle of scratch memory in `memory`; null: no limit.
/// Throws Cancelled and OverMemory.
std::vector<std::uint8_t> find_duplicate_triangles(const Mesh& mesh, const Appearance* appearance,
                                                   Progress* progress = nullptr,
                                                   MemoryBudget* memory = nullptr);

}  // namespace voxdag
