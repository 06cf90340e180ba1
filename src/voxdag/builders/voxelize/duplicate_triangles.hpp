#pragma once
/// Finds triangles that cover what another triangle covers.
#include "voxdag/builders/voxelize/grid_mapping.hpp"
#include "voxdag/core/parallel/find_duplicates.hpp"

namespace voxdag {

/// Returns all triangles that are exact duplicates of one with a lower index: they have the same
/// three corners on the grid, in any order. Triangles that are not in range are in no set; their
/// pieces are. Cost, errors and progress are those of find_duplicates.
IndexSet find_duplicate_triangles(const QuantizedMesh& mesh, Work work = {});

}  // namespace voxdag
