#pragma once
/// Sorts a mesh's triangles into the sub-volumes that they meet.
#include <cstdint>
#include <span>

#include "voxdag/builders/voxelize/cell_range.hpp"
#include "voxdag/builders/voxelize/duplicate_triangles.hpp"
#include "voxdag/builders/voxelize/grid_mapping.hpp"
#include "voxdag/core/page_vector.hpp"
#include "voxdag/core/parallel/work.hpp"

namespace voxdag {

/// For each cell of one octree level that a triangle meets, the list of these triangles.
struct SubvolumeBins {
  explicit SubvolumeBins(MemoryBudget* budget) : cells(budget), begin(budget), triangles(budget) {}

  int level = 0;
  PageVector<std::uint32_t> cells;  ///< Morton codes of the cells, ascending.
  PageVector<std::uint64_t> begin;  ///< cells.size() + 1 entries: where each cell's list starts.
  PageVector<std::uint32_t> triangles;  ///< Indices into the mesh.

  std::span<const std::uint32_t> list(std::size_t cell) const {
    return {triangles.data() + begin[cell], triangles.data() + begin[cell + 1]};
  }
};

/// Bins the triangles that are not in `excluded` into those cells of `level`, <= levels - 2 and <=
/// 10, that lie in `range`, which is of the same or a coarser level. A triangle is in the list of
/// every such cell that it meets and, except in the largest grids, of no other. The order in a list
/// depends on timing. Time is linear in the size of the lists. Memory is at most 16 bytes per entry
/// during the call and 4 afterwards. Throws OverMemory and Cancelled.
SubvolumeBins bin_triangles(const QuantizedMesh& mesh, int levels, int level,
                            const CellRange& range, const IndexSet& excluded, Work work);

}  // namespace voxdag
