#pragma once
/// Filters the colours and normals of a mesh over the cells of its DAG.
///
/// Every cell of the finest level m gets the mean over the surface in it, as a leaf of an ESVO does
/// (pieces/surface_sum.hpp); a cell above has the mean of its children, weighted by area. A cell
/// without visible surface has the value of the cell above it: the DAG has voxels where the alpha
/// test removes the surface, because its shape ignores colours.
///
/// The upper cells are listed breadth first, down to the tasks: cells with at most 65,536 cells
/// below them and few triangles. Tasks run in parallel. Memory holds the upper cells and a few
/// tasks, however many cells there are.

#include "voxdag/attributes/cell_value_sink.hpp"
#include "voxdag/core/grid.hpp"
#include "voxdag/core/memory_budget.hpp"
#include "voxdag/layout/cell_index.hpp"
#include "voxdag/mesh/mesh.hpp"
#include "voxdag/parallel/progress.hpp"
#include "voxdag/surface/surface_shading.hpp"

namespace voxdag {

/// Gives the values of all cells that `index` numbers to the sink. `dag` is the DAG of the mesh in
/// `grid`, and `index` numbers its cells. `shading` is the shading of the mesh; null: grey. Counts
/// its memory in `memory`; null: no limit. The values depend on mesh, grid and level alone, not on
/// the number of threads. Throws OverMemory, Cancelled, and whatever the sink throws.
void filter_cells(const Mesh& mesh, const Grid& grid, const SvdagView& dag,
                  const CellIndexView& index, const SurfaceShading* shading, CellValueSink& sink,
                  MemoryBudget* memory = nullptr, Progress* progress = nullptr);

}  // namespace voxdag
