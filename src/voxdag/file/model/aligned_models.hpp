#pragma once
/// Set operations on models whose grids may differ.
#include "voxdag/algebra/combine.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/file/model/edited.hpp"

namespace voxdag {

/// Two models in a common grid. Refers to both.
class AlignedModels {
 public:
  /// Throws Error with the reason if no grid holds both (align_grids.hpp), OverMemory and
  /// Cancelled.
  AlignedModels(const DagModel& first, const DagModel& second, Work work);
  AlignedModels(const AlignedModels&) = delete;
  AlignedModels& operator=(const AlignedModels&) = delete;

  /// Returns the common grid.
  const Grid& grid() const { return grid_; }
  /// Returns the result of the operation in the common grid. Throws what voxdag::combine() throws.
  Svdag combine(SetOperation operation) const;
  /// Returns the grid of the result: that of the first model if the operation keeps only voxels of
  /// it, else the common one.
  const Grid& grid_of(SetOperation operation) const;
  /// Returns the result in grid_of(operation).
  Svdag result(SetOperation operation) const;
  /// Returns the models whose voxels the result has, and where it has them: both, or the first.
  std::vector<PlacedModel> placed(SetOperation operation) const;

 private:
  /// Returns the model's DAG in the common grid; `storage` holds it if it had to move.
  SvdagView moved(const DagModel& model, Vec3i by, Svdag& storage) const;

  const DagModel &first_, &second_;
  Work work_;
  Grid grid_;
  Vec3i place_, second_place_;  ///< Voxels (0,0,0) of the models in the common grid.
  Svdag moved_a_, moved_b_;
  SvdagView dag_a_, dag_b_;
};

}  // namespace voxdag
