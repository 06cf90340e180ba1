#pragma once
/// Cuts a grid into parts of about equal work.
#include <cstdint>
#include <span>
#include <vector>

#include "voxdag/builders/voxelize/cell_range.hpp"
#include "voxdag/cluster/triangle_segments.hpp"

namespace voxdag {

/// Estimates of the triangles in one cell.
struct CellLoad {
  std::uint64_t triangles = 0;
  double voxels = 0;

  /// Returns the bytes that the build of the cell needs: an estimate that serves as its work, too.
  double bytes() const;
};

/// Adds the cells of a segment to the loads of all cells of its level, by Morton code.
void add_loads(const TriangleSegment& segment, std::span<CellLoad> loads);

/// Cuts the cells of `level` into runs, in Morton order: a run ends where its bytes reach
/// `part_bytes`, or one cell has more. Leaves out empty cells at both ends of a run.
std::vector<CellRange> plan_parts(std::span<const CellLoad> loads, int level, double part_bytes);

}  // namespace voxdag
