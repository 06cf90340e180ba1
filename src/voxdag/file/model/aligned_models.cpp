#include "voxdag/file/model/aligned_models.hpp"

#include "voxdag/algebra/align_grids.hpp"
#include "voxdag/algebra/shift.hpp"

namespace voxdag {

AlignedModels::AlignedModels(const DagModel& first, const DagModel& second, Work work)
    : first_(first), work_(work) {
  const AlignedGrids aligned = align_grids(first.grid(), second.grid());
  grid_ = aligned.grid;
  place_ = aligned.first;
  dag_a_ = moved(first, aligned.first, moved_a_);
  dag_b_ = moved(second, aligned.second, moved_b_);
}

SvdagView AlignedModels::moved(const DagModel& model, Vec3i by, Svdag& storage) const {
  if (by == Vec3i{} && model.grid().levels == grid_.levels) return model.view();
  storage = shift(model.view(), by, grid_.levels, work_);
  return storage.view();
}

Svdag AlignedModels::combine(SetOperation operation) const {
  return voxdag::combine(dag_a_, dag_b_, operation, work_);
}

const Grid& AlignedModels::grid_of(SetOperation operation) const {
  const bool keeps_first =
      operation == SetOperation::kIntersection || operation == SetOperation::kDifference;
  return keeps_first ? first_.grid() : grid_;
}

Svdag AlignedModels::result(SetOperation operation) const {
  Svdag dag = combine(operation);
  const Grid& grid = grid_of(operation);
  if (grid == grid_) return dag;
  const Vec3i back{-place_.x, -place_.y, -place_.z};
  return shift(dag.view(), back, grid.levels, work_);
}

}  // namespace voxdag
