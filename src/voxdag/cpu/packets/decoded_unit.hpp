#pragma once
/// Decoded units of a compact DAG, with the boxes that packets of rays need.
#include <cstdint>

#include "voxdag/cpu/packets/bounded_node.hpp"
#include "voxdag/trace/compact_svdag_nodes.hpp"

namespace voxdag {

/// A unit and its bricks, shared ones too, as bounded_node.hpp lays nodes out: at most nine nodes
/// with eight children each.
struct DecodedUnit {
  /// The unit is at word 0. A pointer is half the word index of a brick, or the place of a leaf
  /// block in `leaf_blocks`. Eight more words are safe to read.
  std::uint32_t words[2 * (9 + 8 * 8 + 8) + 8] = {};
  std::uint64_t leaf_blocks[64] = {};
};

/// Fills in `decoded`. shared_brick(number, mask) returns the DecodedBrick of a shared brick.
template <class SharedBrick>
void set_unit(const CompactUnit& unit, const SharedBrick& shared_brick, DecodedUnit& decoded) {
  std::uint64_t brick_at = bounded_node_words(unit.mask) / 2;
  std::uint32_t leaf_at = 0;
  write_bounded_node(unit.mask, decoded.words, [&](std::uint32_t, std::uint32_t octant) {
    const std::uint32_t mask = unit.brick_masks[octant];
    const std::uint64_t(&leaves)[8] = (unit.inline_mask >> octant & 1) != 0
                                          ? unit.bricks[octant]
                                          : shared_brick(unit.shared[octant], mask).leaves;
    const auto pointer = static_cast<std::uint32_t>(brick_at);
    brick_at += bounded_node_words(mask) / 2;
    const CellBox box = write_bounded_node(mask, decoded.words + 2 * pointer,
                                           [&](std::uint32_t, std::uint32_t leaf) {
                                             decoded.leaf_blocks[leaf_at] = leaves[leaf];
                                             return BoundedChild{leaf_at++, box_of(leaves[leaf])};
                                           });
    return BoundedChild{pointer, box};
  });
}

}  // namespace voxdag
