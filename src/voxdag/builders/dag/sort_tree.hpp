#pragma once
/// The build by sorting: its octree or partly reduced DAG, the sink that collects the nodes, and
/// the reduction to the minimal DAG.
///
/// Source: Kämpe, Sintorn, Assarsson, "High Resolution Sparse Voxel DAGs", SIGGRAPH 2013, Section
/// 3. Works bottom-up, one level at a time. Sorts the nodes with their child pointers as the key,
/// compacts the sorted list to its unique nodes, records in a table of indirections where each node
/// went, and rewrites the pointers of the level above.
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "voxdag/builders/dag/node_store.hpp"
#include "voxdag/core/page_vector.hpp"
#include "voxdag/core/parallel/work.hpp"

namespace voxdag {

/// The pointers to a node's eight children; kNoNode for absent ones. Also the sort key of the node.
using SortNode = std::array<std::uint32_t, 8>;

/// Nodes by level; pointers are indices into the level below. Level 0 is the tree's root.
struct SortTree {
  SortTree(int level_count, MemoryBudget* budget) : leaf_blocks(budget) {
    for (int level = 0; level < level_count; ++level) levels.emplace_back(budget);
  }

  std::uint64_t bytes() const {
    std::uint64_t bytes = leaf_blocks.size() * sizeof(std::uint64_t);
    for (const auto& level : levels) bytes += level.size() * sizeof(SortNode);
    return bytes;
  }
  /// Gives all memory back.
  void release() {
    for (auto& level : levels) level.release();
    leaf_blocks.release();
  }

  std::vector<PageVector<SortNode>> levels;
  PageVector<std::uint64_t> leaf_blocks;  ///< Below the last of `levels`.
};

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

/// Wall-clock seconds of the thread that called.
struct SortTimes {
  double reduce = 0;  ///< The whole reduction, with sorting.
  double sort = 0;
};

/// Merges all equal nodes, level by level. The nodes of level 0 are merged only if `merge_roots` is
/// set; otherwise the roots keep their indices. `parallel`: sort on all threads. Throws OverMemory
/// and Cancelled; the tree is then unusable.
void reduce_by_sorting(SortTree& tree, bool merge_roots, bool parallel, SortTimes& times,
                       Work work);

}  // namespace voxdag
