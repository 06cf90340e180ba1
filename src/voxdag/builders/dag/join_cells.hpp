#pragma once
/// Builds the few nodes above the sub-volumes.
#include <algorithm>
#include <cstdint>
#include <vector>

#include "voxdag/builders/dag/node_store.hpp"

namespace voxdag {

/// Joins the nodes of the cells of `level` (Morton codes, ascending; `ids` has kNoNode for empty
/// cells) up to the root and returns its id, or kNoNode if all cells are empty. make_node(level,
/// words, count) makes each node from its child mask and the ids of its children, and returns its
/// id.
template <class MakeNode>
NodeId join_cells(int level, std::vector<std::uint32_t> cells, std::vector<NodeId> ids,
                  const MakeNode& make_node) {
  for (; level > 0; --level) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < cells.size();) {
      const std::uint32_t parent = cells[i] >> 3;
      std::uint32_t words[9] = {};
      int count = 1;
      for (; i < cells.size() && cells[i] >> 3 == parent; ++i) {
        if (ids[i] == kNoNode) continue;
        words[0] |= 1u << (cells[i] & 7);
        words[count++] = ids[i];
      }
      cells[kept] = parent;
      ids[kept++] = count == 1 ? kNoNode : make_node(level - 1, words, count);
    }
    cells.resize(kept);
    ids.resize(kept);
  }
  return ids.empty() ? kNoNode : ids[0];
}

}  // namespace voxdag
