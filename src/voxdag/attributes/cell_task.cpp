#include "voxdag/attributes/cell_task.hpp"

#include <algorithm>
#include <bit>

namespace voxdag {
namespace {

/// Sets the values of the cells without visible surface among `values` to `value`.
void fill_unseen(std::span<VoxelValue> values, const VoxelValue& value) {
  // The value of visible surface always has a normal.
  for (VoxelValue& of_cell : values)
    if (of_cell.normal == Vec3f{}) of_cell = value;
}

}  // namespace

CellFilter::CellFilter(const SvdagView& dag, const CellIndexView& index,
                       const TriangleSource& source, const SurfaceShading* shading,
                       bool with_normals, MemoryBudget* memory)
    : dag_(dag), index_(index), source_(source), sampler_(shading, with_normals), pieces_(memory) {}

SurfaceSum CellFilter::filter(const CellTask& task, std::vector<VoxelValue>& values) {
  const std::uint64_t cells = cells_in(dag_, index_, task.cell);
  first_ = task.cell.number;
  sums_.assign(cells, {});
  values.assign(cells, {});
  for (std::size_t begin = 0; begin < task.triangles.size(); begin += kMostLoaded) {
    const std::size_t count = std::min(kMostLoaded, task.triangles.size() - begin);
    load_pieces(pieces_, sampler_, source_, task.cell.level, task.place,
                task.triangles.subspan(begin, count));
    add_pieces(task.cell, pieces_.root());
  }
  pieces_.finish();
  const SurfaceSum sum = join(task.cell, values);
  sums_ = {};  // counted only until this task ends
  return sum;
}

/// Adds the pieces of triangles in a cell to the sums of the finest cells in it.
void CellFilter::add_pieces(const NumberedCell& cell, StackedCell part) {
  if (sampler_.shading() != nullptr)
    pieces_.remove_if(part, [this](const Cell& view, const TrianglePiece& piece) {
      return sampler_.is_alpha_masked(view, piece);
    });
  if (part.is_empty()) return;
  if (cell.level == index_.finest_level) {
    sums_[cell.number - first_].add(sum_pieces(pieces_.view(part), sampler_));
    return;
  }
  const PieceStack::Split split = pieces_.begin_split(part);
  for (std::uint32_t left = split.children & children_of(dag_, cell); left != 0; left &= left - 1) {
    const int child = std::countr_zero(left);
    const StackedCell of_child = pieces_.push_child(part, split, child);
    add_pieces(child_of(dag_, index_, cell, child), of_child);
    pieces_.pop(of_child);
  }
  pieces_.end_split(split);
}

/// Returns the sum over a cell, from the sums of its children. Sets the values of its subtree.
SurfaceSum CellFilter::join(const NumberedCell& cell, std::vector<VoxelValue>& values) {
  SurfaceSum& sum = sums_[cell.number - first_];
  if (cell.level != index_.finest_level)
    for (std::uint32_t left = children_of(dag_, cell); left != 0; left &= left - 1)
      sum.add(join(child_of(dag_, index_, cell, std::countr_zero(left)), values));
  if (!(sum.area > 0)) return sum;
  const auto own = values.begin() + static_cast<std::ptrdiff_t>(cell.number - first_);
  *own = voxel_value(sum);
  if (cell.level != index_.finest_level)
    fill_unseen({own + 1, cells_in(dag_, index_, cell) - 1}, *own);
  return sum;
}

}  // namespace voxdag
