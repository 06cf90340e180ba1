#pragma once
/// Builds the minimal sparse voxel DAG of a triangle mesh's exact cover.
#include <cstdint>

#include "voxdag/core/grid.hpp"
#include "voxdag/core/memory_budget.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/mesh/mesh.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

enum class BuildMethod {
  /// Depth-first with hash-consing and the plane memo. Memory grows with the DAG, not with the
  /// octree; in planar regions time does too.
  kHashConsed,
  /// The paper's method with sub-volumes in parallel: builds octrees of sub-volumes of at most
  /// 1024³, reduces each level by level by sorting, then merges all by one more reduction. The DAG
  /// is identical.
  kSort,
  /// The paper's method as the paper runs and measures it: one sub-volume at a time, each sorted on
  /// all threads. The DAG is identical.
  kPaper,
};

/// The stages of a build. Seconds are wall-clock.
struct BuildReport {
  double quantize_seconds = 0;   ///< Vertices to integers, triangles into sub-volumes.
  double voxelize_seconds = 0;   ///< Sub-volumes to nodes; both methods reduce them as they go.
  double merge_seconds = 0;      ///< The final reduction of all sub-volumes, by sorting.
  double canonical_seconds = 0;  ///< Numbering in canonical order.
  /// The time of all reductions and of joining their results, and the part of it spent in sorting.
  /// kPaper: wall-clock, as in the paper's Table 1. kSort: summed over threads, without joining.
  double reduce_seconds = 0;
  double sort_seconds = 0;
  std::uint64_t subvolumes = 0;
  std::uint64_t peak_bytes = 0;  ///< Most bytes that the budget counted.
};

struct BuildResult {
  Svdag dag;
  BuildReport report;
  MemoryReservation memory;  ///< Counts `dag` in the budget of the work.
};

/// Builds the DAG of all voxels of `grid` that the mesh's triangles meet (design: exact cover).
/// Runs on the current TBB arena. The result depends on mesh and grid alone: not on threads, method
/// or machine. Throws OverMemory, with an estimate of the memory that the build needs, if the limit
/// is too small; it does so before the work if the limit is clearly too small. Throws Error if the
/// DAG outgrows 32-bit pointers, and Cancelled. The build does not count the mesh; its owner does.
BuildResult build_svdag(const Mesh& mesh, const Grid& grid,
                        BuildMethod method = BuildMethod::kHashConsed, Work work = {});

}  // namespace voxdag
