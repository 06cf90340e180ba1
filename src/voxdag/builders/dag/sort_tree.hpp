#pragma once
/// The octree or partly reduced DAG of the build by sorting.
#include <array>
#include <cstdint>
#include <vector>

#include "voxdag/builders/dag/node_store.hpp"
#include "voxdag/core/page_vector.hpp"

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

}  // namespace voxdag
