#pragma once
/// Sorts a mesh's triangles into the sub-volumes that they meet.
#include <cstdint>
#include <span>
#include <vector>

#include "voxdag/core/memory_budget.hpp"
#include "voxdag/parallel/progress.hpp"
#include "voxdag/voxelize/grid_mapping.hpp"

namespace voxdag {

/// The sub-volumes are the cells of one octree level; those that no triangle meets are left out.
struct SubvolumeBins {
  int level = 0;
  std::vector<std::uint32_t> cells;  ///< Morton codes of the cells, ascending.
  std::vector<std::uint64_t> begin;  ///< cells.size() + 1 entries: where each cell's list starts.
  std::vector<std::uint32_t> triangles;  ///< Indices into the mesh, ascending in each list.

  std::span<const std::uint32_t> list(std::size_t cell) const {
    return {triangles.data() + begin[cell], triangles.data() + begin[cell + 1]};
  }
};

/// A triangle is in the list of every cell that it meets, and, but for the largest grids, of no
/// other. level <= levels - 2 and <= 10. Time is linear in the lists; memory is 12 bytes per entry
/// while it sorts, 4 after.
SubvolumeBins bin_triangles(const QuantizedMesh& mesh, int levels, int level, MemoryBudget& budget,
                            const Progress* progress);

}  // namespace voxdag
