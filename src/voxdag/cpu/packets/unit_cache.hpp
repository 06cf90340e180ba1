#pragma once
/// A cache of decoded units of a compact DAG.
#include <cstdint>
#include <vector>

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

class InPlaceDag;

/// The units that one thread decoded last.
class UnitCache {
 public:
  /// `units` is the number of units that the cache holds: a power of two.
  explicit UnitCache(std::size_t units)
      : units_(units), numbers_(units, kNone), bricks_(kBricks), brick_numbers_(kBricks, kNone) {}

  /// Returns a unit of the DAG. The reference is valid until the next call.
  const DecodedUnit& unit(const InPlaceDag& dag, std::uint32_t number) {
    const std::size_t place = number & (units_.size() - 1);
    if (numbers_[place] != number) decode(dag, number, place);
    return units_[place];
  }
  /// Returns how many units were decoded so far.
  std::uint64_t decoded_units() const { return decoded_units_; }
  std::uint64_t bytes() const;

 private:
  static constexpr std::uint64_t kNone = ~std::uint64_t{0};
  static constexpr std::size_t kBricks = 1 << 12;

  void decode(const InPlaceDag& dag, std::uint32_t number, std::size_t place);
  const DecodedBrick& shared_brick(const CompactSvdagView& compact, std::uint32_t number,
                                   std::uint32_t mask);

  std::vector<DecodedUnit> units_;
  std::vector<std::uint64_t> numbers_;  ///< The number of each unit of `units_`, or kNone.
  std::vector<DecodedBrick> bricks_;    ///< Shared bricks.
  std::vector<std::uint64_t> brick_numbers_;
  CompactUnit unit_;  ///< The unit that decode() reads.
  std::uint64_t decoded_units_ = 0;
};

}  // namespace voxdag
