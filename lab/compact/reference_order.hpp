#pragma once
/// Orders nodes by the number of pointers to them, so that frequent pointers are small.
#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "lab/compact/dag_nodes.hpp"

namespace voxdag::lab {

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

/// Places the words of all nodes, and returns the number of nodes. Each level has its own places,
/// in reference_order(). Levels are placed from the last one up, because the words of a pointer
/// depend on the place of the child. A node has one word for its tags, and words_of(child) words
/// for each child; words_of is make_words_of(level, places of the level below).
template <class Node, class MakeWordsOf>
std::uint64_t place_levels(const std::vector<std::vector<Node>>& levels, std::size_t leaf_blocks,
                           const MakeWordsOf& make_words_of) {
  std::uint64_t count = 0, place = 0;
  std::vector<std::uint64_t> places(leaf_blocks);
  if (!levels.empty())
    for (const std::uint32_t leaf : reference_order(levels.back(), leaf_blocks))
      places[leaf] = place++;
  for (std::size_t level = levels.size(); level-- > 0;) {
    const std::vector<Node>& nodes = levels[level];
    auto words_of = make_words_of(level, places);
    const std::vector<std::uint32_t> order = level == 0
                                                 ? std::vector<std::uint32_t>{0}
                                                 : reference_order(levels[level - 1], nodes.size());
    std::vector<std::uint64_t> here(nodes.size());
    std::uint64_t at = 0;
    for (const std::uint32_t i : order) {
      here[i] = at++;
      ++count;
      for (const auto& child : nodes[i])
        if (child.node != kNoNode) at += words_of(child);
    }
    places = std::move(here);
  }
  return count;
}

}  // namespace voxdag::lab
