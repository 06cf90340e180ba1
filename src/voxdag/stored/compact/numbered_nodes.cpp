#include "voxdag/stored/compact/numbered_nodes.hpp"

#include <algorithm>

#include "voxdag/core/parallel/polled_for.hpp"

namespace voxdag {

NumberedNodes::NumberedNodes(const SvdagView& dag, Work work)
    : dag_(dag), tags_(dag.node_words(), 0, work.memory), lists_(work.memory, 0) {
  nodes_.resize(static_cast<std::size_t>(brick_level()));
  shared_.resize(static_cast<std::size_t>(brick_level()) + 1);
  shared_[0] = {0};
  nodes_[0] = {0};
  std::uint64_t listed = 2;
  for (int level = 1; level <= brick_level(); ++level) {
    // A node of this level has as many pointers as the level above says.
    const std::uint64_t above = dag.level_begin[level - 1], begin = dag.level_begin[level],
                        end = dag.level_begin[level + 1];
    for (std::uint64_t at = above; at < begin;) {
      work.poll_seldom(at);
      const int children = popcount(dag.nodes[at]);
      for (int i = 1; i <= children; ++i) {
        std::uint32_t& pointers = tags_[dag.nodes[at + static_cast<unsigned>(i)]];
        if (pointers + 1 < kShared) ++pointers;
      }
      at += static_cast<unsigned>(1 + children);
    }

    std::uint64_t nodes = 0, shared = 0;
    for (std::uint64_t at = begin; at < end;
         at += static_cast<unsigned>(words_of_node(dag.nodes + at))) {
      ++nodes;
      shared += tags_[at] > 1 ? 1 : 0;
    }
    listed += shared + (level <= unit_level() ? nodes : 0);
    lists_.resize(listed * sizeof(std::uint32_t));

    // The pointers to each shared node, and its position; then in the order of the numbers.
    std::vector<std::uint32_t>& order = shared_[index(level)];
    order.reserve(shared);
    if (level <= unit_level()) nodes_[index(level)].reserve(nodes);
    for (std::uint64_t at = begin; at < end;
         at += static_cast<unsigned>(words_of_node(dag.nodes + at))) {
      work.poll_seldom(at);
      const auto word = static_cast<std::uint32_t>(at);
      if (tags_[at] > 1) order.push_back(word);
      if (level <= unit_level()) {
        if (tags_[at] == 1) tags_[at] = 0;
        nodes_[index(level)].push_back(word);
      }
    }
    const bool are_bricks = level == brick_level();
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      if (are_bricks && dag.nodes[a] != dag.nodes[b]) return dag.nodes[a] < dag.nodes[b];
      return tags_[a] > tags_[b];
    });
    if (are_bricks) {
      for (const std::uint32_t word : order) ++brick_first_[dag.nodes[word] + 1];
      for (std::size_t m = 1; m < brick_first_.size(); ++m) brick_first_[m] += brick_first_[m - 1];
    }
    for (std::size_t number = 0; number < order.size(); ++number)
      tags_[order[number]] = kShared | static_cast<std::uint32_t>(number);

    if (level > unit_level()) continue;
    for (std::size_t position = 0; position < nodes_[index(level)].size(); ++position) {
      const std::uint32_t word = nodes_[index(level)][position];
      if ((tags_[word] & kShared) != 0) {
        order[tags_[word] & ~kShared] = static_cast<std::uint32_t>(position);
      } else {
        tags_[word] = static_cast<std::uint32_t>(position);
      }
    }
  }
}

}  // namespace voxdag
