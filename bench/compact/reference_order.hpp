#pragma once
/// Orders nodes by the number of pointers to them, so that frequent pointers are small.
#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

#include "bench/compact/dag_nodes.hpp"

namespace voxdag {

/// Returns the indices of the `count` nodes to which the children of `parents` point, most pointers
/// first. Nodes with equally many pointers keep their order, which the papers leave open.
template <class Node>
std::vector<std::uint32_t> reference_order(const std::vector<Node>& parents, std::size_t count) {
  std::vector<std::uint64_t> references(count, 0);
  for (const Node& parent : parents)
    for (const auto& child : parent)
      if (child.node != kNoNode) ++references[child.node];
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), std::uint32_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return references[a] > references[b]; });
  return order;
}

}  // namespace voxdag
