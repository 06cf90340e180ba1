#include "voxdag/attributes/filter_cells.hpp"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/task_arena.h>

#include "voxdag/attributes/cell_task.hpp"
#include "voxdag/attributes/top_cells.hpp"
#include "voxdag/parallel/ordered_pipeline.hpp"
#include "voxdag/pieces/duplicate_surfaces.hpp"
#include "voxdag/pieces/memory_gate.hpp"

namespace voxdag {
namespace {

/// Filters tasks. Several threads may filter different tasks at the same time.
class TaskFilter {
 public:
  TaskFilter(const SvdagView& dag, const CellIndexView& index, const TriangleSource& source,
             const SurfaceShading* shading, CellValueSink& sink, MemoryBudget* memory)
      : dag_(dag),
        index_(index),
        sink_(sink),
        memory_(memory),
        gate_(memory),
        filters_([&dag, &index, &source, shading, memory] {
          return CellFilter(dag, index, source, shading, memory);
        }) {}

  /// Filters the task, keeps its sum in it and frees its triangles. Returns the number of cells.
  std::uint64_t filter(NumberedTopCell& task) {
    const std::uint64_t cells = cells_in(dag_, index_, task.cell);
    const std::uint64_t bytes = cells * CellFilter::kBytesPerCell;
    const MemoryGate::Pass pass(gate_, bytes + CellFilter::piece_bytes(task.triangles.size()));
    const MemoryReservation counted(memory_, bytes);
    std::vector<VoxelValue> values;
    task.sum = filters_.local().filter({task.cell, task.place, task.triangles}, values);
    if (!(task.sum.area > 0)) fill_unseen(values, grey_value());
    sink_.add(task.cell.number, values);
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

/// Gives the values of the cells above the tasks to the sink. Children follow their parents in
/// `cells`, in the order of their places.
void finish_top_cells(NumberedTopCells& cells, CellValueSink& sink) {
  for (std::size_t i = cells.size(); i-- > 0;) {
    NumberedTopCell& cell = cells[i];
    if (cell.is_task) continue;
    for (std::size_t k = 0; k < cell.child_count; ++k)
      cell.sum.add(cells[cell.first_child + k].sum);
    const VoxelValue value = cell.sum.area > 0 ? voxel_value(cell.sum) : grey_value();
    sink.add(cell.cell.number, {&value, 1});
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
          progress->report("colours", static_cast<double>(done) / static_cast<double>(index.cells),
                           done);
      });
  finish_top_cells(cells, sink);
}

}  // namespace voxdag
