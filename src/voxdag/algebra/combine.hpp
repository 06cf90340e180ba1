#pragma once
/// Set operations on DAGs.
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

enum class SetOperation {
  kUnion,         ///< Voxels of a, of b, or of both.
  kIntersection,  ///< Voxels of a that are voxels of b.
  kDifference,    ///< Voxels of a that are not voxels of b.
  kSymmetric,     ///< Voxels of either a or b.
};

/// Returns the minimal DAG, in canonical order, of the voxels that `operation` selects. Both DAGs
/// must be valid and have equal numbers of levels. The time and memory follow the number of
/// different pairs of nodes at equal places. Throws Error if the result outgrows 32-bit pointers,
/// OverMemory and Cancelled.
Svdag combine(const SvdagView& a, const SvdagView& b, SetOperation operation, Work work = {});

}  // namespace voxdag
