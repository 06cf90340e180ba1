#pragma once
/// Copies the nodes of one root to a DAG of its own.
#include <cstdint>

#include "voxdag/core/parallel/work.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

/// Returns the nodes that `dag.root` reaches, in canonical order. No two nodes of a level may be
/// equal. The root's words lie before `words_end`, its leaf blocks before dag.leaf_block_count.
/// O(nodes) time; partly on one thread. Throws Error if they outgrow 32-bit
/// pointers, OverMemory and Cancelled.
Svdag canonical_copy(const SvdagView& dag, std::uint64_t words_end, Work work = {});

}  // namespace voxdag
