#pragma once
/// The bits of a compact DAG by part.
#include <cstdint>

#include "voxdag/stored/compact/compact_svdag.hpp"

namespace voxdag {

struct CompactParts {
  std::uint64_t node_bits = 0;  ///< Records of nodes above the units.
  std::uint64_t unit_bits = 0;  ///< Units with their inline bricks.
  std::uint64_t shared_brick_bits = 0;
};

/// Returns the parts of the stream. Reads each node above the units once.
CompactParts compact_parts(const CompactSvdagView& compact);

}  // namespace voxdag
