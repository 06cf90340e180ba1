#pragma once
/// Filters the cells of one subtree of a DAG.
#include <algorithm>
#include <span>
#include <vector>

#include "voxdag/layout/numbered_cell.hpp"
#include "voxdag/pieces/load_pieces.hpp"
#include "voxdag/pieces/sum_pieces.hpp"

namespace voxdag {

/// A cell whose subtree one thread filters in one step.
struct CellTask {
  NumberedCell cell;
  Vec3i place{};                             ///< In cells of its level.
  std::span<const std::uint32_t> triangles;  ///< Those that meet it.
};

/// Filters tasks, one at a time. Each thread has its own.
class CellFilter {
 public:
  /// Refers to the arguments. Counts the pieces of triangles in `memory`; null: no limit. Without
  /// `with_normals`, the normals of the values are meaningless unit vectors.
  CellFilter(const SvdagView& dag, const CellIndexView& index, const TriangleSource& source,
             const SurfaceShading* shading, bool with_normals, MemoryBudget* memory);

  /// The largest number of triangles that are cut into pieces at a time.
  static constexpr std::size_t kMostLoaded = 1 << 14;

  /// The bytes that filter() needs for each cell in the subtree. The caller counts them.
  static constexpr std::uint64_t kBytesPerCell = sizeof(SurfaceSum) + sizeof(VoxelValue);

  /// Returns the bytes that the pieces of a task's triangles are expected to take.
  static std::uint64_t piece_bytes(std::size_t triangles) {
    return std::min(triangles, kMostLoaded) * PieceStack::kBytesPerTriangle;
  }

  /// Returns the sum over the task's cell. Sets `values` to the values of all cells in its subtree,
  /// in the order of their numbers. A cell without visible surface gets the value of the nearest
  /// cell above it in the subtree that has some; `values` is meaningless if no cell has any (the
  /// area of the sum is 0). Throws OverMemory.
  SurfaceSum filter(const CellTask& task, std::vector<VoxelValue>& values);

 private:
  void add_pieces(const NumberedCell& cell, StackedCell part);
  SurfaceSum join(const NumberedCell& cell, std::vector<VoxelValue>& values);

  const SvdagView& dag_;
  const CellIndexView& index_;
  const TriangleSource& source_;
  const PieceSampler sampler_;
  PieceStack pieces_;
  std::uint64_t first_ = 0;       // number of the task's cell
  std::vector<SurfaceSum> sums_;  // of all cells in the task, by number - first_
};

}  // namespace voxdag
