#pragma once
/// Fills the inside of meshes.
#include <cstdint>

#include "voxdag/core/memory_budget.hpp"
#include "voxdag/layout/svdag.hpp"
#include "voxdag/mesh/mesh.hpp"
#include "voxdag/parallel/progress.hpp"
#include "voxdag/voxelize/grid_mapping.hpp"

namespace voxdag {

enum class SolidRule {
  /// A voxel is inside if a ray from it crosses an odd number of triangles. Exact for closed
  /// meshes,
  /// which may intersect themselves and be nested. Where two bodies overlap, they cancel each other
  /// out.
  kParity,
  /// An empty voxel is inside if no way over faces through empty voxels connects it with the sides
  /// of the grid. For meshes whose voxels leave no gap. It fills cavities, too.
  kFlood,
};

/// Returns the minimal DAG, in canonical order, of the voxels of `cover`, which must be the DAG of
/// the mesh on this grid, and of those inside. No triangle meets the empty voxels, so all voxels of
/// a connected set of them are inside or none is. Time and memory grow with `cover` and with the
/// mesh, not with the voxels.
///
/// kParity throws Error if the mesh is not closed, or if it reaches out of the range of
/// QuantizedMesh. Throws OverMemory and Cancelled; `memory` and `progress` may be null.
Svdag fill_solid(const SvdagView& cover, const Mesh& mesh, const Grid& grid, SolidRule rule,
                 MemoryBudget* memory = nullptr, Progress* progress = nullptr);

}  // namespace voxdag
