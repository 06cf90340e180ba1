#include "voxdag/builders/attributes/cell_filter.hpp"

#include <bit>

#include "voxdag/core/checked_size.hpp"

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
    : dag_(dag),
      index_(index),
      pieces_(dag, index, source, PieceSampler(shading, with_normals), memory) {}

SurfaceSum CellFilter::filter(const CellTask& task, std::vector<VoxelValue>& values) {
  const std::uint64_t cells = cells_in(dag_, index_, task.cell);
  first_ = task.cell.number;
  sums_.assign(cells, {});
  values.assign(cells, {});
  pieces_.for_each_finest_cell(task, [this](const NumberedCell& cell, const Cell& pieces) {
    sums_[cell.number - first_].add(sum_pieces(pieces, pieces_.sampler()));
  });
  const SurfaceSum sum = join(task.cell, values);
  sums_ = {};  // counted only until this task ends
  return sum;
}

/// Returns the sum over a cell, from the sums of its children. Sets the values of its subtree.
SurfaceSum CellFilter::join(const NumberedCell& cell, std::vector<VoxelValue>& values) {
  SurfaceSum& sum = sums_[cell.number - first_];
  if (cell.level != index_.finest_level)
    for (std::uint32_t left = children_of(dag_, cell); left != 0; left &= left - 1)
      sum.add(join(child_of(dag_, index_, cell, std::countr_zero(left)), values));
  if (!(sum.area > 0)) return sum;
  VoxelValue* const own = values.data() + static_cast<std::ptrdiff_t>(cell.number - first_);
  *own = voxel_value(sum);
  if (cell.level != index_.finest_level)
    fill_unseen({own + 1, checked_size(cells_in(dag_, index_, cell) - 1)}, *own);
  return sum;
}

}  // namespace voxdag
