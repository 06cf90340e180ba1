#pragma once
/// Filters the colours and normals of a mesh over the cells of its DAG.
///
/// A cell of the finest level m gets the mean over the surface in it, as a leaf of an ESVO does
/// (builders/pieces/surface_sum.hpp). A cell above gets the mean of its children, weighted by area.
/// The DAG also has voxels where the alpha test removes the surface, because its shape ignores
/// alpha. A cell without visible surface gets the value of the nearest cell above it that has some.
///
/// filter_cells() first lists the upper cells breadth first, down to the tasks: cells with at most
/// 65,536 cells in their subtrees and few triangles. Threads then filter tasks in parallel. Memory
/// holds the upper cells and a few tasks, however many cells there are.
#include "voxdag/builders/attributes/cell_value_sink.hpp"
#include "voxdag/core/grid.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/mesh/mesh.hpp"
#include "voxdag/mesh/surface/surface_shading.hpp"
#include "voxdag/stored/attributes/cell_index.hpp"

namespace voxdag {

/// Filters all cells that `index` numbers and gives their values to the sink. `dag` is the DAG of
/// the mesh in `grid`, and `index` numbers its cells. `shading` is the shading of the mesh; null:
/// grey. The values depend on mesh, shading, grid and level alone, not on the number of threads.
/// Counts its memory in `work`. Throws OverMemory and Cancelled, and what the sink throws.
void filter_cells(const Mesh& mesh, const Grid& grid, const SvdagView& dag,
                  const CellIndexView& index, const SurfaceShading* shading, CellValueSink& sink,
                  Work work = {});

}  // namespace voxdag
