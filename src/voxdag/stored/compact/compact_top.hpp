#pragma once
/// The nodes of a compact DAG above its units, expanded to words with pointers.
///
/// They are a small part of a DAG's nodes, but rays visit them most often.
#include <cstdint>
#include <vector>

#include "voxdag/core/parallel/work.hpp"
#include "voxdag/stored/compact/compact_nodes.hpp"

namespace voxdag {

/// Levels are coded levels; level C-4 is that of the units.
struct CompactTop {
  /// The nodes of levels 0 to C-5, in canonical order (svdag.hpp): child mask, then a pointer to
  /// each child. A pointer is the child's first word in its level; pointers of level C-5 are the
  /// places of units in `units`.
  std::vector<CountedVector<std::uint32_t>> levels;
  CountedVector<CompactRange> units;  ///< The bits of each unit, in canonical order.
};

/// Expands the nodes above the units. Throws Error if the stream is broken or a level outgrows
/// 32-bit pointers, OverMemory and Cancelled. The DAG must not be empty.
CompactTop expand_top(const CompactSvdagView& compact, Work work);

}  // namespace voxdag
