#pragma once
/// Builds one part of a grid from the segments of its mesh.
#include <span>

#include "voxdag/cluster/triangle_segments.hpp"
#include "voxdag/cluster/work_file.hpp"
#include "voxdag/core/memory_budget.hpp"
#include "voxdag/core/parallel/work.hpp"

namespace voxdag {

struct PartCounts {
  std::uint64_t triangles = 0;  ///< Triangles that were voxelized; one in two pieces counts twice.
  std::uint64_t pieces = 0;
};

/// Builds the DAG of the voxels in `range`, a run of cells of the segments' level, in a grid of
/// 2^levels voxels a side, and writes it to `file`. If the build does not fit into what is left of
/// the budget, it goes on with smaller pieces, and takes the triangles of one cell in batches.
/// Throws OverMemory if the smallest piece does not fit, Error and Cancelled.
PartCounts build_part(std::span<const TriangleSegment> segments, int levels, const CellRange& range,
                      WorkFileWriter& file, Work work);

}  // namespace voxdag
