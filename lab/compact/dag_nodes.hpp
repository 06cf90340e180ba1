#pragma once
/// A DAG as lists of nodes, one a level: a child is an index into the list of the next level.
#include <array>
#include <cstdint>
#include <vector>

#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag::lab {

inline constexpr std::uint32_t kNoNode = ~std::uint32_t{0};

/// Nodes in the order of the layout. Levels 0..L-3 have nodes, level L-2 has leaf blocks.
struct DagNodes {
  using Node = std::array<std::uint32_t, 8>;  ///< A child for each octant, or kNoNode.

  std::vector<std::vector<Node>> nodes;
  std::vector<std::uint64_t> leaf_blocks;
};

DagNodes list_nodes(const SvdagView& dag);

}  // namespace voxdag::lab
