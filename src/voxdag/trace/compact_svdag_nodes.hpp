#pragma once
/// The node layout for rays at a compact DAG (stored/compact/compact_svdag.hpp).
///
/// Rays decode the nodes that they reach, so a cache of decoded nodes saves most of the time: a
/// unit is decoded as a whole, and rays near each other reach the same units. A cache is a type
/// with
///   node(dag, range, level)         returns the node of a level above the units
///   unit(dag, range)                returns the unit
///   shared_brick(dag, number, mask) returns the eight leaf blocks of the brick
/// Each returns a reference that is valid until the next call. Nodes that cannot be decoded have no
/// voxels.
#include "voxdag/stored/compact/compact_nodes.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

/// The leaf blocks of a brick; 0 for octants without voxels.
struct DecodedBrick {
  std::uint64_t leaves[8] = {};
};

namespace detail {

VOXDAG_HD inline void decode(const CompactSvdagView& dag, CompactRange range, int level,
                             CompactNode& node) {
  if (read_node(dag, range, level, node) != CompactFault::kNone) node.mask = 0;
}
VOXDAG_HD inline void decode(const CompactSvdagView& dag, CompactRange range, CompactUnit& unit) {
  if (read_unit(dag, range, unit) != CompactFault::kNone) unit.mask = 0;
}
VOXDAG_HD inline void decode(const CompactSvdagView& dag, std::uint32_t number, std::uint32_t mask,
                             DecodedBrick& brick) {
  const CompactRange range = shared_node(dag, dag.coded_levels() - 3, number);
  if (read_shared_brick(dag, range, mask, brick.leaves) != CompactFault::kNone)
    for (std::uint64_t& leaf : brick.leaves) leaf = 0;
}

}  // namespace detail

/// A cache of the one node, unit and brick that were decoded last: for a thread of a GPU.
class LastDecoded {
 public:
  VOXDAG_HD const CompactNode& node(const CompactSvdagView& dag, CompactRange range, int level) {
    if (!is_same(range, node_range_)) detail::decode(dag, range, level, node_);
    node_range_ = range;
    return node_;
  }
  VOXDAG_HD const CompactUnit& unit(const CompactSvdagView& dag, CompactRange range) {
    if (!is_same(range, unit_range_)) detail::decode(dag, range, unit_);
    unit_range_ = range;
    return unit_;
  }
  VOXDAG_HD const DecodedBrick& shared_brick(const CompactSvdagView& dag, std::uint32_t number,
                                             std::uint32_t mask) {
    if (number != brick_number_) detail::decode(dag, number, mask, brick_);
    brick_number_ = number;
    return brick_;
  }

 private:
  static constexpr std::uint64_t kNone = ~std::uint64_t{0};
  VOXDAG_HD static bool is_same(CompactRange a, CompactRange b) {
    return a.begin == b.begin && a.end == b.end;
  }

  CompactRange node_range_{kNone, kNone}, unit_range_{kNone, kNone};
  std::uint64_t brick_number_ = kNone;
  CompactNode node_;
  CompactUnit unit_;
  DecodedBrick brick_;
};

/// See svdag_nodes.hpp for the members of a node layout. Casts that run at the same time need
/// caches of their own.
template <class Cache>
class CompactSvdagNodes {
 public:
  /// `range` says where a node above the bricks is, or, for an inline brick, its unit. For a shared
  /// brick `range.begin` is the number; for a leaf block and a node of level L-1 it is the mask.
  struct Node {
    CompactRange range;
    std::uint8_t octant = 0;  ///< A brick's octant in its unit; kShared for a shared one.
    std::uint8_t mask = 0;    ///< A brick's child mask.
  };

  VOXDAG_HD CompactSvdagNodes(const CompactSvdagView& dag, Cache& cache)
      : dag_(dag),
        cache_(&cache),
        levels_(dag.levels),
        missing_(dag.coded_levels() - dag.levels),
        unit_level_(dag.coded_levels() - 4) {}

  VOXDAG_HD bool is_empty() const { return dag_.is_empty(); }
  VOXDAG_HD int levels() const { return levels_; }
  VOXDAG_HD Node root() const {
    Node node{root_node(dag_)};
    for (int level = 0; level < missing_; ++level) node = coded_child(node, level, 0);
    return node;
  }

  VOXDAG_HD std::uint32_t child_mask(const Node& node, int level) const {
    const int below = level + missing_ - unit_level_;
    if (below < 0) return cache_->node(dag_, node.range, level + missing_).mask;
    if (below == 0) return cache_->unit(dag_, node.range).mask;
    if (below == 1) return node.mask;
    if (below == 2) return leaf_block_child_mask(node.range.begin);
    return static_cast<std::uint32_t>(node.range.begin);
  }
  VOXDAG_HD Node child(const Node& node, int level, int index) const {
    return coded_child(node, level + missing_, index);
  }

 private:
  static constexpr std::uint8_t kShared = 8;

  VOXDAG_HD Node coded_child(const Node& node, int coded_level, int index) const {
    const int below = coded_level - unit_level_;
    if (below < 0) return {cache_->node(dag_, node.range, coded_level).children[index]};
    if (below == 0) {
      const CompactUnit& unit = cache_->unit(dag_, node.range);
      if ((unit.inline_mask >> index & 1) != 0)
        return {node.range, static_cast<std::uint8_t>(index), unit.brick_masks[index]};
      return {{unit.shared[index], 0}, kShared, unit.brick_masks[index]};
    }
    if (below == 1) {
      if (node.octant != kShared)
        return {{cache_->unit(dag_, node.range).bricks[node.octant][index], 0}};
      const auto number = static_cast<std::uint32_t>(node.range.begin);
      return {{cache_->shared_brick(dag_, number, node.mask).leaves[index], 0}};
    }
    return {{node.range.begin >> (8 * index) & 0xFF, 0}};
  }

  CompactSvdagView dag_;
  Cache* cache_;
  int levels_;
  int missing_;     ///< Coded levels above the grid's root.
  int unit_level_;  ///< The coded level of units.
};

}  // namespace voxdag
