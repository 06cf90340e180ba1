#pragma once
/// Filters the colours and normals of the cells of one subtree of a DAG.
#include <vector>

#include "voxdag/builders/attributes/cell_task.hpp"
#include "voxdag/builders/pieces/surface_sum.hpp"

namespace voxdag {

/// Filters tasks, one at a time. Each thread has its own.
class CellFilter {
 public:
  /// Refers to the arguments. Counts the pieces of triangles in `memory`. Without `with_normals`,
  /// the normals of the values are meaningless unit vectors.
  CellFilter(const SvdagView& dag, const CellIndexView& index, const TriangleSource& source,
             const SurfaceShading* shading, bool with_normals, MemoryBudget* memory);

  /// The bytes that filter() needs for each cell in the subtree. The caller counts them.
  static constexpr std::uint64_t kBytesPerCell = sizeof(SurfaceSum) + sizeof(VoxelValue);

  /// Returns the sum over the task's cell. Sets `values` to the values of all cells in its subtree,
  /// in the order of their numbers. A cell without visible surface gets the value of the nearest
  /// cell above it in the subtree that has some; `values` is meaningless if no cell has any (the
  /// area of the sum is 0). Throws OverMemory.
  SurfaceSum filter(const CellTask& task, std::vector<VoxelValue>& values);

 private:
  SurfaceSum join(const NumberedCell& cell, std::vector<VoxelValue>& values);

  const SvdagView& dag_;
  const CellIndexView& index_;
  TaskPieces pieces_;
  std::uint64_t first_ = 0;       // number of the task's cell
  std::vector<SurfaceSum> sums_;  // of all cells in the task, by number - first_
};

}  // namespace voxdag
