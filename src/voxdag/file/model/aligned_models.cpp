#include "voxdag/file/model/aligned_models.hpp"

#include "voxdag/algebra/align_grids.hpp"
#include "voxdag/algebra/shift.hpp"

namespace voxdag {
namespace {

bool keeps_first(SetOperation operation) {
  return operation == SetOperation::kIntersection || operation == SetOperation::kDifference;
}

}  // namespace

AlignedModels::AlignedModels(const DagModel& first, const DagModel& second, Work work)
    : first_(first), second_(second), work_(work) {
  const AlignedGrids aligned = align_grids(first.grid(), second.grid());
  grid_ = aligned.grid;
  place_ = aligned.first;
  second_place_ = aligned.second;
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
  return keeps_first(operation) ? first_.grid() : grid_;
}

std::vector<PlacedModel> AlignedModels::placed(SetOperation operation) const {
  if (keeps_first(operation)) return {{first_}};
  return {{first_, {}, place_}, {second_, {}, second_place_}};
}

Svdag AlignedModels::result(SetOperation operation) const {
  Svdag dag = combine(operation);
  const Grid& grid = grid_of(operation);
  if (grid == grid_) return dag;
  const Vec3i back{-place_.x, -place_.y, -place_.z};
  return shift(dag.view(), back, grid.levels, work_);
}

}  // namespace voxdag
