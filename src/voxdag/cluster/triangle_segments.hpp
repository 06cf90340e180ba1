#pragma once
/// The triangles of a mesh on the grid's integers, in files, with an index of the coarse cells that
/// they meet.
///
/// A segment holds a run of the mesh's triangles:
///
///   SegmentHeader
///   QuantizedTriangle[triangles]   in the order of the first cell that each meets
///   u32 entries[entries]           for each cell after the other, the triangles that meet it
///   zeros                          up to a multiple of 8
///   SegmentCell[cells]             in the order of their Morton codes
#include <cstdint>
#include <span>
#include <vector>

#include "voxdag/builders/voxelize/cell_range.hpp"
#include "voxdag/builders/voxelize/grid_mapping.hpp"
#include "voxdag/cluster/shared_mesh.hpp"
#include "voxdag/cluster/work_folder.hpp"
#include "voxdag/core/memory_budget.hpp"
#include "voxdag/core/parallel/work.hpp"

namespace voxdag {

struct SegmentHeader {
  std::uint64_t triangles, entries, cells;
};

/// A cell of a segment. Its entries end where those of the next cell begin.
struct SegmentCell {
  std::uint32_t code;       ///< Morton code at the level of the segments' cells.
  std::uint32_t triangles;  ///< Number of entries.
  std::uint64_t begin;      ///< First entry.
  double voxels;            ///< Estimated number of voxels of these triangles in the cell.
};
static_assert(sizeof(SegmentCell) == 24);

/// Returns the level of the cells in a grid of 2^levels voxels a side: small enough to divide the
/// work among many, and so large that they seldom cut a triangle.
int segment_cell_level(int levels);

/// Returns the name of segment `index` in the work folder.
std::string segment_name(std::uint64_t index);

/// Returns the triangles of a segment for the budget: as many as fit into a quarter of what is
/// left, at most 2^21.
std::uint64_t segment_triangles(const MemoryBudget& budget);

/// Writes segment `index`: the triangles of `mesh` from `first` to `last` - 1. The file depends on
/// these and the grid alone. Throws Error, OverMemory and Cancelled.
void write_segment(const WorkFolder& folder, std::uint64_t index, const SharedMesh& mesh,
                   const Grid& grid, std::uint64_t first, std::uint64_t last, Work work);

/// A segment that was read.
class TriangleSegment {
 public:
  /// Throws Error if the file does not hold a segment.
  explicit TriangleSegment(WorkFile file);

  std::span<const SegmentCell> cells() const { return cells_; }
  /// Returns the number of entries of the cells of `range`, which is of level `level` or finer.
  std::uint64_t entries_in(const CellRange& range, int level) const;
  /// Appends the triangles that meet cells of `range`, each once. Skips the first `skip` of them,
  /// and stops when `triangles` has `most`. Returns how many of them it has passed, and whether
  /// these are all.
  struct Taken {
    std::uint64_t passed = 0;
    bool is_all = true;
  };
  Taken take(const CellRange& range, int level, std::uint64_t skip, std::uint64_t most,
             CountedVector<QuantizedTriangle>& triangles, MemoryBudget* budget) const;

 private:
  std::span<const SegmentCell> cells_in(const CellRange& range, int level) const;

  WorkFile file_;
  std::span<const QuantizedTriangle> triangles_;
  std::span<const std::uint32_t> entries_;
  std::span<const SegmentCell> cells_;
};

}  // namespace voxdag
