#include "voxdag/attributes/filter_cells.hpp"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>

#include "voxdag/attributes/cell_task.hpp"
#include "voxdag/attributes/top_cells.hpp"
#include "voxdag/parallel/ordered_pipeline.hpp"
#include "voxdag/pieces/duplicate_surfaces.hpp"
#include "voxdag/pieces/memory_gate.hpp"

namespace voxdag {
namespace {

/// Filters tasks. Thread-safe.
class TaskFilter {
 public:
  TaskFilter(const SvdagView& dag, const CellIndexView& index, const TriangleSource& source,
             const SurfaceShading* shading, CellValueSink& sink, MemoryBudget* memory)
      : dag_(dag),
        index_(index),
        sink_(sink),
        memory_(memory),
        gate_(memory),
        filters_([&dag, &index, &source, shading, with_normals = sink.needs_normals(), memory] {
          return CellFilter(dag, index, source, shading, with_normals, memory);
        }) {}

  /// Filters the task, stores its sum in it and frees its triangles. Gives the values to the sink,
  /// unless the task has no visible surface. Returns the number of cells.
  std::uint64_t filter(NumberedTopCell& task) {
    const std::uint64_t cells = cells_in(dag_, index_, task.cell);
    const std::uint64_t bytes = cells * CellFilter::kBytesPerCell;
    const MemoryGate::Pass pass(gate_, bytes + CellFilter::piece_bytes(task.triangles.size()));
    const MemoryReservation counted(memory_, bytes);
    std::vector<VoxelValue> values;
    task.sum = filters_.local().filter({task.cell, task.place, task.triangles}, values);
    if (task.sum.area > 0) sink_.add(task.cell.number, values);
    task.triangles = TriangleList(memory_);
    return cells;
  }

 private:
  const SvdagView& dag_;
  const CellIndexView& index_;
  CellValueSink& sink_;
  MemoryBudget* memory_;
  MemoryGate gate_;
  tbb::enumerable_thread_specific<CellFilter> filters_;
};

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
                  MemoryBudget* memory, Progress* progress) {
  if (dag.is_empty()) return;
  const QuantizedMesh quantized(mesh, grid, memory, progress);
  const MemoryReservation tables(memory, quantized.triangle_count());
  const Appearance* const appearance = shading != nullptr ? &shading->appearance() : nullptr;
  const IndexSet duplicates = find_duplicate_surfaces(mesh, appearance, progress, memory);
  const std::vector<std::uint8_t> no_open_edges(quantized.triangle_count());
  const TriangleSource source{grid, quantized, no_open_edges, nullptr, duplicates};
  NumberedTopCells cells = list_top_cells(dag, index, source, memory, progress);
  const std::vector<std::size_t> tasks = tasks_in_order(cells);
  TaskFilter filter(dag, index, source, shading, sink, memory);
  std::uint64_t done = 0;
  ordered_pipeline(
      tasks.size(), 2 * static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()), progress,
      [&](std::size_t i) { return filter.filter(cells[tasks[i]]); },
      [&](std::uint64_t count) {
        done += count;
        if (progress != nullptr)
          progress->report("attributes",
                           static_cast<double>(done) / static_cast<double>(index.cells), done);
      });
  finish_top_cells(dag, index, cells, sink);
}

}  // namespace voxdag
