#pragma once
/// Decoded units of a compact DAG, in the form that BoundedDag has for the nodes of a plain one.
#include <cstdint>

#include "voxdag/cpu/packets/cell_box.hpp"
#include "voxdag/trace/compact_svdag_nodes.hpp"

namespace voxdag {

/// A unit and its bricks, shared ones too, at most nine nodes with eight children each.
struct DecodedUnit {
  /// The unit is at word 0. See BoundedDag; the pointers of bricks are places in `leaf_blocks`.
  /// Eight more words are safe to read.
  std::uint32_t words[2 * (9 + 8 * 8 + 8) + 8] = {};
  std::uint64_t leaf_blocks[64] = {};

  CellBox box() const { return {words[1]}; }
};

/// Fills in `decoded`. shared_brick(number, mask) returns the DecodedBrick of a shared brick.
template <class SharedBrick>
void set_unit(const CompactUnit& unit, const SharedBrick& shared_brick, DecodedUnit& decoded) {
  std::uint32_t brick_at = 1 + static_cast<std::uint32_t>(popcount8(unit.mask)), leaf_at = 0;
  std::uint32_t* const pointers = decoded.words + 2;
  std::uint32_t* const boxes = pointers + popcount8(unit.mask);
  CellExtent of_unit;
  std::uint32_t child = 0;
  for (std::uint32_t i = 0; i < 8; ++i) {
    if ((unit.mask >> i & 1) == 0) continue;
    const std::uint32_t mask = unit.brick_masks[i];
    const std::uint64_t(&leaves)[8] = (unit.inline_mask >> i & 1) != 0
                                          ? unit.bricks[i]
                                          : shared_brick(unit.shared[i], mask).leaves;
    std::uint32_t* const brick = decoded.words + 2 * brick_at;
    const auto count = static_cast<std::uint32_t>(popcount8(mask));
    CellExtent of_brick;
    std::uint32_t leaf = 0;
    for (std::uint32_t q = 0; q < 8; ++q) {
      if ((mask >> q & 1u) == 0) continue;
      const CellBox box = box_of(leaves[q]);
      of_brick.add(box, q);
      brick[2 + leaf] = leaf_at;
      brick[2 + count + leaf] = box.bits;
      decoded.leaf_blocks[leaf_at++] = leaves[q];
      ++leaf;
    }
    brick[0] = mask;
    brick[1] = of_brick.box().bits;
    of_unit.add({brick[1]}, i);
    pointers[child] = brick_at;
    boxes[child] = brick[1];
    brick_at += 1 + count;
    ++child;
  }
  decoded.words[0] = unit.mask;
  decoded.words[1] = of_unit.box().bits;
}

}  // namespace voxdag
