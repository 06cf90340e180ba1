#pragma once
/// The upper cells of a DAG with the triangles in them, down to the tasks: cells whose subtrees
/// one thread filters in one step.
#include <cstdint>
#include <vector>

#include "voxdag/builders/pieces/child_triangles.hpp"
#include "voxdag/builders/pieces/surface_sum.hpp"
#include "voxdag/builders/pieces/triangle_source.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/stored/attributes/numbered_cell.hpp"

namespace voxdag {

struct NumberedTopCell {
  NumberedCell cell;
  Vec3i place{};           ///< In cells of its level.
  bool is_task = false;    ///< Its children are not among the cells.
  TriangleList triangles;  ///< Those that meet it. Empty unless a task.
  SurfaceSum sum;          ///< Over the surface in it. filter_cells() sets it.
  VoxelValue value;        ///< filter_cells() sets it.
  std::size_t first_child = 0, child_count = 0;  ///< The range of its children in the list.
};

using NumberedTopCells = CountedVector<NumberedTopCell>;

/// Lists the cells from the root down to the tasks, breadth first. Counts them in `work`. The DAG
/// must have voxels. Throws Cancelled and OverMemory.
NumberedTopCells list_top_cells(const SvdagView& dag, const CellIndexView& index,
                                const TriangleSource& source, Work work);

/// Returns the indices of the tasks in `cells`, in the order of their cells' numbers.
std::vector<std::size_t> tasks_in_order(const NumberedTopCells& cells);

}  // namespace voxdag
