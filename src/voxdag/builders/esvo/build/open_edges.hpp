#pragma once
/// Finds the edges that bound a surface.
#include <cstdint>
#include <vector>

#include "voxdag/builders/voxelize/grid_mapping.hpp"
#include "voxdag/core/memory_budget.hpp"
#include "voxdag/core/parallel/find_duplicates.hpp"

namespace voxdag {

/// Returns a bit mask for each triangle of the mesh: bit e is set if no other triangle has an edge
/// between the same two points as its edge from corner e to the next. Points are the same if they
/// are rounded to the same 1/256 voxel. Pieces of clipped triangles have no open edges. Triangles
/// in `ignored` (indices of the mesh's triangles) do not count. Counts 24 bytes per triangle of
/// scratch memory in `work`. Throws Cancelled and OverMemory.
std::vector<std::uint8_t> find_open_edges(const QuantizedMesh& mesh,
                                          const IndexSet& ignored = IndexSet(), Work work = {});

}  // namespace voxdag
