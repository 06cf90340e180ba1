#include "voxdag/builders/attributes/top_cells.hpp"

#include <algorithm>
#include <bit>

#include "voxdag/builders/attributes/cell_task.hpp"
#include "voxdag/builders/pieces/split_triangles.hpp"
#include "voxdag/core/parallel/parallel_for.hpp"

namespace voxdag {
namespace {

/// The most cells in the subtree of a task.
constexpr std::uint64_t kTaskCells = 1 << 16;
/// The most triangles of a task. Leaf blocks and finest cells are tasks with any number.
constexpr std::size_t kTaskTriangles = TaskPieces::kMaxLoaded;

}  // namespace

NumberedTopCells list_top_cells(const SvdagView& dag, const CellIndexView& index,
                                const TriangleSource& source, Work work) {
  NumberedTopCells cells(work.memory);
  cells.resize(1);
  cells[0].triangles = triangles_of_grid(source, work.memory);
  for (std::size_t begin = 0; begin < cells.size();) {
    const std::size_t end = cells.size();
    std::vector<ChildTriangles> lists(end - begin, empty_children(work.memory));
    parallel_for(end - begin, [&](std::size_t i) {
      if (work.cancelled()) return;
      NumberedTopCell& top = cells[begin + i];
      top.is_task =
          top.cell.level == index.finest_level || top.cell.level >= dag.levels - 2 ||
          (cells_in(dag, index, top.cell) <= kTaskCells && top.triangles.size() <= kTaskTriangles);
      if (top.is_task) return;
      lists[i] = split_triangles(source, top.cell.level, top.place, top.triangles, work.memory);
      top.triangles = TriangleList(work.memory);
    });
    work.poll();
    for (std::size_t at = begin; at < end; ++at) {
      if (cells[at].is_task) continue;
      cells[at].first_child = cells.size();
      for (std::uint32_t left = children_of(dag, cells[at].cell); left != 0; left &= left - 1) {
        const int child = std::countr_zero(left);
        NumberedTopCell top;
        top.cell = child_of(dag, index, cells[at].cell, child);
        top.place = cells[at].place * 2 + child_offset(child);
        top.triangles = std::move(lists[at - begin][static_cast<std::size_t>(child)]);
        cells.push_back(std::move(top));
        ++cells[at].child_count;
      }
    }
    begin = end;
  }
  return cells;
}

std::vector<std::size_t> tasks_in_order(const NumberedTopCells& cells) {
  std::vector<std::size_t> tasks;
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (cells[i].is_task) tasks.push_back(i);
  std::sort(tasks.begin(), tasks.end(), [&](std::size_t a, std::size_t b) {
    return cells[a].cell.number < cells[b].cell.number;
  });
  return tasks;
}

}  // namespace voxdag
