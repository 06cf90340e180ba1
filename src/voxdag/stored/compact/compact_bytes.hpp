#pragma once
/// The head of a compact DAG: all that a reader needs beside the stream.
///
/// The head is one message of the adaptive coder (adaptive_bits.hpp), which docs/format.md
/// specifies. It holds, in this order, the numbers of shared nodes by level, the numbers of shared
/// bricks by mask, the shapes of the six trees, the tables of each tree, and the lengths of the
/// shared nodes in bits.
#include <cstddef>
#include <span>
#include <vector>

#include "voxdag/stored/compact/compact_svdag.hpp"

namespace voxdag {

/// Returns the head of `compact`; no bytes if it has no voxels.
std::vector<std::byte> compact_head(const CompactSvdag& compact);

/// Returns a compact DAG of `levels` levels with this head and without a stream. Throws
/// Error("", place, reason) if the head is damaged or does not fit a stream of `stream_words`
/// words. The place is "tree 3", "table 17 of tree 3", "shared nodes" or "stream". Takes time and
/// memory in proportion to the bytes of head and stream, whatever the bytes are.
CompactSvdag parse_compact_head(std::span<const std::byte> head, int levels,
                                std::uint64_t stream_words);

}  // namespace voxdag
