#pragma once
/// Collects the nodes of a build by sorting.
#include <bit>
#include <cstdint>

#include "voxdag/builders/dag/pending_node.hpp"
#include "voxdag/builders/dag/sort_tree.hpp"

namespace voxdag {

/// Builds the explicit octree of one sub-volume. Merges no nodes: ids are indices into `tree`.
class TreeSink {
 public:
  static constexpr bool kMemo = false;

  /// `root_level` is the level of the sub-volume, `levels` the level of the voxels.
  TreeSink(int levels, int root_level, MemoryBudget& budget)
      : tree(levels - 2 - root_level, &budget), root_level_(root_level) {}

  void prefetch(int, const PendingNode&) const {}
  void prefetch_found(int, const PendingNode&) const {}

  void leaves(const std::uint64_t* blocks, int count, NodeId* ids) {
    for (int i = 0; i < count; ++i) {
      ids[i] = static_cast<NodeId>(tree.leaf_blocks.size());
      tree.leaf_blocks.push_back(blocks[i]);
    }
  }
  NodeId leaf(const PendingNode& pending) {
    tree.leaf_blocks.push_back(pending.words[0] | static_cast<std::uint64_t>(pending.words[1])
                                                      << 32);
    return static_cast<NodeId>(tree.leaf_blocks.size() - 1);
  }
  NodeId node(int level, const PendingNode& pending) {
    SortNode node;
    node.fill(kNoNode);
    const std::uint32_t* child = pending.words + 1;
    for (std::uint32_t left = pending.words[0]; left != 0; left &= left - 1)
      node[std::countr_zero(left)] = *child++;
    PageVector<SortNode>& nodes = tree.levels[level - root_level_];
    nodes.push_back(node);
    return static_cast<NodeId>(nodes.size() - 1);
  }

  SortTree tree;  ///< Leaf blocks are in Morton order of their cells.

 private:
  int root_level_;
};

}  // namespace voxdag
