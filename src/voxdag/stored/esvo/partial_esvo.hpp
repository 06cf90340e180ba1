#pragma once
/// An ESVO that has only some of its blocks in memory.
///
/// A descriptor is *cut* while the block of its children is missing. It then marks its children as
/// leaves, and the slot of its far pointer holds the index of the missing block. So the octree is
/// complete at any time, but coarser where blocks are missing.
#include <cstdint>

#include "voxdag/stored/esvo/esvo.hpp"

namespace voxdag {

/// A view for kernels and readers: owns nothing.
struct PartialEsvoView {
  EsvoView octree;
  const std::uint32_t* cut = nullptr;  ///< One bit per slot: whether its descriptor is cut.

  /// Returns the missing block to which the descriptor in `slot` leads, or -1.
  VOXDAG_HD std::int64_t missing_block(std::uint64_t slot) const {
    if ((cut[slot / 32] >> (slot % 32) & 1u) == 0) return -1;
    return static_cast<std::int64_t>(octree.slots[slot + octree.descriptor(slot).child_pointer()]);
  }
};

/// The slots [begin, begin + count) of a block in memory: whole pages.
struct SlotRange {
  std::uint64_t begin = 0, count = 0;
};

}  // namespace voxdag
