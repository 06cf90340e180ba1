#pragma once
/// Filters the cells of one subtree of a DAG.
#include <algorithm>
#include <span>
#include <vector>

#include "voxdag/layout/numbered_cell.hpp"
#include "voxdag/pieces/load_pieces.hpp"
#include "voxdag/pieces/sum_pieces.hpp"

namespace voxdag {

/// A cell whose subtree is filtered at once.
struct CellTask {
  NumberedCell cell;
  Vec3i place{};                             ///< In cells of its level.
  std::span<const std::uint32_t> triangles;  ///< Those that meet it.
};

/// The scratch memory of a thread. Filters one task after the other.
class CellFilter {
 public:
  /// Refers to the arguments.
  CellFilter(const SvdagView& dag, const CellIndexView& index, const TriangleSource& source,
             const SurfaceShading* shading, MemoryBudget* memory);

  /// The bytes that a task takes for each cell in the subtree.
  static constexpr std::uint64_t kBytesPerCell = sizeof(SurfaceSum) + sizeof(VoxelValue);

  /// Returns the expected bytes of the pieces of a task's triangles.
  static std::uint64_t piece_bytes(std::size_t triangles) {
    return std::min(triangles, kMostLoaded) * PieceStack::kBytesPerTriangle;
  }

  /// Returns the sum over the task's cell. Sets `values` to the values of all cells in its subtree,
  /// in the order of their numbers.
  SurfaceSum filter(const CellTask& task, std::vector<VoxelValue>& values);

 private:
  /// The largest number of triangles that are cut into pieces at a time.
  static constexpr std::size_t kMostLoaded = 1 << 14;

  void add_pieces(const NumberedCell& cell, StackedCell part);
  SurfaceSum join(const NumberedCell& cell, std::vector<VoxelValue>& values);

  const SvdagView& dag_;
  const CellIndexView& index_;
  const TriangleSource& source_;
  const PieceSampler sampler_;
  PieceStack pieces_;
  std::uint64_t most_kept_bytes_ = ~std::uint64_t{0};  // of pieces between two tasks
  std::uint64_t first_ = 0;                            // number of the task's cell
  std::vector<SurfaceSum> sums_;                       // of the cells of the finest level
};

/// Returns the value of a cell without visible surface: grey.
VoxelValue grey_value();

/// Sets the values of cells without visible surface among `values` to `value`.
void fill_unseen(std::span<VoxelValue> values, const VoxelValue& value);

/// Returns the value that marks cells without visible surface.
constexpr VoxelValue unseen_value() { return {}; }

}  // namespace voxdag
