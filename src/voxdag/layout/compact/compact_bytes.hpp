#pragma once
/// The bytes of what a compact DAG has beside its stream: the head.
///
/// One message of the adaptive coder (adaptive_bits.hpp); docs/format.md specifies it. In this
/// order: the numbers of shared nodes of levels 0 to C-3, those of the shared bricks by mask, the
/// six trees, the tables of each tree, and the lengths of the shared nodes in bits.
#include <cstddef>
#include <span>
#include <vector>

#include "voxdag/layout/compact/compact_svdag.hpp"

namespace voxdag {

/// Returns the head of `compact`; no bytes if it has no voxels.
std::vector<std::byte> compact_head(const CompactSvdag& compact);

/// Returns a compact DAG of `levels` with this head, whose stream, of `stream_words` words, is
/// still missing. Throws Error("", place, reason) if the head is damaged or does not fit such a
/// stream; the place is "tree 3", "table 17 of tree 3", "shared nodes" or "stream". With any bytes
/// it takes O(bytes of head and stream) time and memory.
CompactSvdag parse_compact_head(std::span<const std::byte> head, int levels,
                                std::uint64_t stream_words);

}  // namespace voxdag
