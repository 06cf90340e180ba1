#pragma once
/// Converts a DAG between the paper's layout and the compact form
/// (stored/compact/compact_svdag.hpp).
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/stored/compact/compact_svdag.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

struct CompactOptions {
  /// The largest number of frequency tables for the masks of cells; fewer for other symbols. More
  /// tables take fewer bytes, and rays take longer. 1 to kMaxTables.
  int tables = 2048;
};

/// Returns the compact form of a DAG, which must be valid and in canonical order. The bits depend
/// on its voxels and on `tables` alone. Runs on the current TBB arena. Throws OverMemory and
/// Cancelled.
CompactSvdag encode_svdag(const SvdagView& dag, const CompactOptions& options = {}, Work work = {});

/// Returns the DAG in the paper's layout and canonical order. Throws Error if the stream is broken
/// or the DAG outgrows 32-bit pointers; OverMemory and Cancelled.
Svdag decode_svdag(const CompactSvdagView& compact, Work work = {});

}  // namespace voxdag
