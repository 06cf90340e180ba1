#include "voxdag/builders/esvo/build/top_cells.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "voxdag/builders/esvo/build/decide_cell.hpp"
#include "voxdag/builders/esvo/build/enclose_cell.hpp"
#include "voxdag/builders/pieces/load_pieces.hpp"
#include "voxdag/builders/pieces/memory_gate.hpp"
#include "voxdag/builders/pieces/split_triangles.hpp"
#include "voxdag/core/morton.hpp"
#include "voxdag/core/parallel/parallel_for.hpp"
#include "voxdag/core/parallel/per_thread.hpp"

namespace voxdag {
namespace {

/// A cell with less surface than this, in voxels², is one task.
constexpr double kTaskWeight = 1 << 16;

/// The log2 side, in voxels, of the smallest cells that are still divided into tasks.
constexpr int kMinLog2 = 2;

/// The log2 side, in voxels, of the cells in which displaced triangles are tessellated.
constexpr int kDisplacedTaskLog2 = 4;

class TopCellFinder {
 public:
  TopCellFinder(const TriangleSource& source, const EsvoSettings& settings,
                const SurfaceShading* shading, MemoryBudget* memory, std::size_t most_loaded)
      : source_(source),
        settings_(settings),
        appearance_(settings, shading),
        memory_(memory),
        most_loaded_(most_loaded),
        gate_(memory),
        scratch_([this] { return CellScratch(settings_, appearance_, memory_); }),
        cells_(memory) {
    cells_.resize(1);
    cells_[0].shape = ConvexPolyhedron::cube();
    cells_[0].triangles = triangles_of_grid(source, memory);
  }

  TopCells find(Work work) {
    for (std::size_t begin = 0; begin < cells_.size();) {
      const std::size_t end = cells_.size();
      std::vector<ChildTriangles> children(end - begin, empty_children(memory_));
      std::atomic<std::size_t> done{0};
      parallel_for(end - begin, [&](std::size_t i) {
        if (work.cancelled()) return;
        decide(cells_[begin + i], children[i]);
        work.report("upper levels", static_cast<double>(++done) / static_cast<double>(end - begin),
                    end);
      });
      work.poll();
      for (std::size_t at = begin; at < end; ++at)
        if (!cells_[at].is_task) add_children(at, children[at - begin]);
      begin = end;
    }
    return std::move(cells_);
  }

 private:
  int log2_size(const TopCell& cell) const { return source_.grid.levels - cell.level; }

  /// Decides a cell and, unless it is a task, lists the triangles of its children.
  void decide(TopCell& cell, ChildTriangles& children) {
    cell.is_displaced =
        std::any_of(cell.triangles.begin(), cell.triangles.end(),
                    [this](std::uint32_t triangle) { return source_.is_displaced(triangle); });
    const bool is_heavy = cell.triangles.size() > most_loaded_ && log2_size(cell) > kMinLog2;
    if (cell.is_displaced || is_heavy)
      decide_unloaded(cell, children);
    else
      decide_loaded(cell, children);
    if (!cell.is_task) cell.triangles = TriangleList(memory_);
  }

  void decide_unloaded(TopCell& cell, ChildTriangles& children) {
    cell.weight = std::ldexp(1.0, 2 * log2_size(cell));
    cell.is_task = cell.is_displaced && log2_size(cell) <= kDisplacedTaskLog2;
    if (cell.is_task) return;
    if (settings_.contours && cell.parent != TopCell::kNoParent)
      cell.decision = decide_enclosed(source_, cell.level, cell.cell, cell.triangles,
                                      candidates(cell), cell.shape);
    children = split_triangles(source_, cell.level, cell.cell, cell.triangles, memory_);
  }

  ContourCandidates candidates(const TopCell& cell) {
    if (cell.is_displaced)
      return enclosed_candidates(source_, cell.level, cell.cell, cell.triangles);
    std::vector<std::uint32_t> sample;
    for (std::size_t i = 0; i < cell.triangles.size(); i += candidate_step(cell.triangles.size()))
      sample.push_back(cell.triangles[i]);
    PieceStack pieces;
    load_pieces(pieces, appearance_.sampler(), source_, cell.level, cell.cell, sample);
    return contour_candidates(pieces.view(pieces.root()));
  }

  void decide_loaded(TopCell& cell, ChildTriangles& children) {
    const MemoryGate::Pass pass(gate_, cell.triangles.size() * PieceStack::kBytesPerTriangle);
    CellScratch& scratch = scratch_.local();
    PieceStack& pieces = scratch.pieces;
    load_pieces(pieces, appearance_.sampler(), source_, cell.level, cell.cell, cell.triangles);
    cell.weight = pieces.weight();
    if (cell.parent != TopCell::kNoParent) {
      SurfaceSum sum;
      cell.decision = scratch.decider.decide(pieces.view(pieces.root()),
                                             cells_[cell.parent].decision.is_near, cell.shape, sum);
    }
    cell.is_task =
        cell.decision.is_leaf || log2_size(cell) <= kMinLog2 || cell.weight < kTaskWeight;
    if (!cell.is_task) pieces.list_children(children);
    scratch.pieces.finish();
  }

  void add_children(std::size_t parent, ChildTriangles& children) {
    for (int child = 0; child < 8; ++child) {
      TriangleList& triangles = children[static_cast<std::size_t>(child)];
      if (triangles.empty()) continue;
      ++cells_[parent].children_left;
      TopCell& cell = cells_.emplace_back();
      cell.level = cells_[parent].level + 1;
      cell.cell = cells_[parent].cell * 2 + child_offset(child);
      cell.parent = static_cast<std::uint32_t>(parent);
      cell.child = child;
      cell.triangles = std::move(triangles);
      cell.shape = cells_[parent].shape.octant(child);
    }
    // The triangles that may meet a cell can miss all its children. Then the cell becomes a task
    // without triangles, which tells the parent that the cell is empty.
    if (cells_[parent].children_left == 0) cells_[parent].is_task = true;
  }

  const TriangleSource& source_;
  const EsvoSettings& settings_;
  const CellAppearance appearance_;
  MemoryBudget* const memory_;
  const std::size_t most_loaded_;
  MemoryGate gate_;
  PerThread<CellScratch> scratch_;
  TopCells cells_;
};

}  // namespace

TopCells find_top_cells(const TriangleSource& source, const EsvoSettings& settings,
                        const SurfaceShading* shading, Work work, std::size_t most_loaded) {
  return TopCellFinder(source, settings, shading, work.memory, most_loaded).find(work);
}

std::vector<std::size_t> task_order(const TopCells& cells) {
  std::vector<std::vector<std::size_t>> children(cells.size());
  for (std::size_t i = 1; i < cells.size(); ++i) children[cells[i].parent].push_back(i);
  std::vector<std::size_t> tasks, stack{0};
  while (!stack.empty()) {
    const std::size_t at = stack.back();
    stack.pop_back();
    if (cells[at].is_task) tasks.push_back(at);
    stack.insert(stack.end(), children[at].rbegin(), children[at].rend());
  }
  return tasks;
}

}  // namespace voxdag
