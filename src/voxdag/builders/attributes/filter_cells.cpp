#include "voxdag/builders/attributes/filter_cells.hpp"

#include <algorithm>
#include <array>

#include "voxdag/builders/attributes/cell_filter.hpp"
#include "voxdag/builders/attributes/filter_tasks.hpp"
#include "voxdag/builders/pieces/duplicate_surfaces.hpp"
#include "voxdag/core/parallel/per_thread.hpp"

namespace voxdag {
namespace {

/// Returns the value of all cells of a mesh without visible surface.
VoxelValue grey_value() {
  SurfaceSum grey;
  grey.add(kSurfaceGrey, {0, 1, 0}, 1);
  return voxel_value(grey);
}

void add_copies(std::uint64_t first, std::uint64_t count, const VoxelValue& value,
                CellValueSink& sink) {
  std::array<VoxelValue, 256> copies;
  copies.fill(value);
  while (count > 0) {
    const std::uint64_t part = std::min<std::uint64_t>(count, copies.size());
    sink.add(first, std::span(copies).first(part));
    first += part;
    count -= part;
  }
}

/// Gives the sink the values of the cells above the tasks, and of the cells in tasks without
/// visible surface. All tasks must have their sums.
void finish_top_cells(const SvdagView& dag, const CellIndexView& index, NumberedTopCells& cells,
                      CellValueSink& sink) {
  // Children follow their parents in `cells`.
  for (std::size_t i = cells.size(); i-- > 0;)
    for (std::size_t k = 0; k < cells[i].child_count; ++k)
      cells[i].sum.add(cells[cells[i].first_child + k].sum);
  cells[0].value = grey_value();
  for (NumberedTopCell& cell : cells) {
    const bool is_seen = cell.sum.area > 0;
    if (is_seen) cell.value = voxel_value(cell.sum);
    if (!cell.is_task) sink.add(cell.cell.number, {&cell.value, 1});
    if (cell.is_task && !is_seen)
      add_copies(cell.cell.number, cells_in(dag, index, cell.cell), cell.value, sink);
    // A child without visible surface keeps this value.
    for (std::size_t k = 0; k < cell.child_count; ++k)
      cells[cell.first_child + k].value = cell.value;
  }
}

}  // namespace

void filter_cells(const Mesh& mesh, const Grid& grid, const SvdagView& dag,
                  const CellIndexView& index, const SurfaceShading* shading, CellValueSink& sink,
                  Work work) {
  if (dag.is_empty()) return;
  const QuantizedMesh quantized(mesh, grid, work);
  const MemoryReservation tables(work.memory, quantized.triangle_count());
  const Appearance* const appearance = shading != nullptr ? &shading->appearance() : nullptr;
  const IndexSet duplicates = find_duplicate_surfaces(mesh, appearance, work);
  const std::vector<std::uint8_t> no_open_edges(quantized.triangle_count());
  const TriangleSource source{grid, quantized, no_open_edges, nullptr, duplicates};
  NumberedTopCells cells = list_top_cells(dag, index, source, work);
  PerThread<CellFilter> filters(
      [&] { return CellFilter(dag, index, source, shading, sink.needs_normals(), work.memory); });
  filter_tasks(
      dag, index, cells, CellFilter::kBytesPerCell, work, "attributes",
      [&](const CellTask& task) {
        std::vector<VoxelValue> values;
        const SurfaceSum sum = filters.local().filter(task, values);
        if (sum.area > 0) sink.add(task.cell.number, values);
        return sum;
      },
      [&](std::size_t task, const SurfaceSum& sum) { cells[task].sum = sum; });
  finish_top_cells(dag, index, cells, sink);
}

}  // namespace voxdag
