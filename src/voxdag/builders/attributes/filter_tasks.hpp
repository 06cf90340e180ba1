#pragma once
/// Filters the tasks of a DAG in parallel.

#include "voxdag/builders/attributes/cell_task.hpp"
#include "voxdag/builders/attributes/top_cells.hpp"
#include "voxdag/builders/pieces/memory_gate.hpp"
#include "voxdag/core/parallel/ordered_pipeline.hpp"
#include "voxdag/core/parallel/thread_count.hpp"

namespace voxdag {

/// Calls filter(task) for the tasks among `cells` on many threads, and use(i, result) with each
/// result, in the order of the tasks' numbers; cells[i] is the task. Frees the triangles of a task
/// after filter(). A task starts when `bytes_per_cell` for each cell of its subtree, and the pieces
/// of its triangles, are expected to fit into the budget. Reports the filtered cells as `step`.
/// Throws OverMemory and Cancelled.
template <class Filter, class Use>
void filter_tasks(const SvdagView& dag, const CellIndexView& index, NumberedTopCells& cells,
                  std::uint64_t bytes_per_cell, Work work, const char* step, const Filter& filter,
                  const Use& use) {
  const std::vector<std::size_t> tasks = tasks_in_order(cells);
  MemoryGate gate(work.memory);
  std::size_t next = 0;
  std::uint64_t done = 0;
  ordered_pipeline(
      tasks.size(), 2 * thread_count(), work,
      [&](std::size_t i) {
        NumberedTopCell& task = cells[tasks[i]];
        const std::uint64_t bytes = cells_in(dag, index, task.cell) * bytes_per_cell;
        const MemoryGate::Pass pass(gate,
                                    bytes + TaskPieces::expected_bytes(task.triangles.size()));
        const MemoryReservation counted(work.memory, bytes);
        auto result = filter(CellTask{task.cell, task.place, task.triangles});
        task.triangles = TriangleList(work.memory);
        return result;
      },
      [&](auto& result) {
        const std::size_t task = tasks[next++];
        use(task, result);
        done += cells_in(dag, index, cells[task].cell);
        work.report_done(step, done, index.cells);
      });
}

}  // namespace voxdag
