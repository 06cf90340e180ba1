#pragma once
/// Converts a DAG between the paper's layout and the compact form
/// (stored/compact/compact_svdag.hpp).
#include "voxdag/core/memory_budget.hpp"
#include "voxdag/core/parallel/progress.hpp"
#include "voxdag/stored/compact/compact_svdag.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

struct CompactOptions {
  /// The largest number of frequency tables for the masks of cells; fewer for other symbols. More
  /// tables take fewer bytes, and rays take longer. 1 to kMaxTables.
  int tables = 2048;
  MemoryBudget* memory = nullptr;  ///< Counts and limits the work's memory. Null: no limit.
};

/// Returns the compact form of a DAG, which must be valid and in canonical order. The bits depend
/// on its voxels and on `tables` alone. Runs on the current TBB arena. Throws OverMemory and
/// Cancelled; `progress` may be null.
CompactSvdag encode_svdag(const SvdagView& dag, const CompactOptions& options = {},
                          Progress* progress = nullptr);

/// Returns the DAG in the paper's layout and canonical order. Throws Error if the stream is broken
/// or the DAG outgrows 32-bit pointers; OverMemory and Cancelled.
Svdag decode_svdag(const CompactSvdagView& compact, MemoryBudget* memory = nullptr,
                   Progress* progress = nullptr);

}  // namespace voxdag
