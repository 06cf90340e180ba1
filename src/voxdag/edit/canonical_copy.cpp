#include "voxdag/edit/canonical_copy.hpp"

#include <algorithm>
#include <vector>

#include "voxdag/core/error.hpp"
#include "voxdag/core/page_vector.hpp"
#include "voxdag/core/parallel/polled_for.hpp"
#include "voxdag/edit/base_numbers.hpp"
#include "voxdag/stored/svdag/long_svdag.hpp"

namespace voxdag {
namespace {

/// Walks the nodes level by level, gives each a place when it first meets it, and then copies all.
class CanonicalCopy {
 public:
  CanonicalCopy(const SvdagView& dag, std::uint64_t words_end, Work work)
      : dag_(dag),
        work_(work),
        bytes_(work.memory, (words_end + dag.leaf_block_count) * sizeof(std::uint32_t)),
        nodes_(PageVector<std::uint32_t>::zeros(words_end)),
        blocks_(PageVector<std::uint32_t>::zeros(dag.leaf_block_count)) {}

  Svdag run() {
    Svdag copy;
    copy.levels = dag_.levels;
    const auto leaf_level = static_cast<std::size_t>(dag_.levels - 2);
    std::vector<CountedVector<std::uint32_t>> met(leaf_level + 1,
                                                  CountedVector<std::uint32_t>(work_.memory));
    met[0].push_back(dag_.root);
    (leaf_level == 0 ? blocks_ : nodes_)[dag_.root] = 1;
    std::uint64_t words = leaf_level == 0 ? 0 : words_at(dag_.root);
    for (std::size_t level = 0; level < leaf_level; ++level) {
      const bool is_last = level + 1 == leaf_level;
      copy.level_begin[level + 1] = words;
      meet_below(met[level], is_last, words, met[level + 1]);
    }
    std::fill(copy.level_begin.begin() + dag_.levels - 2, copy.level_begin.end(), words);
    const MemoryReservation result(work_.memory, words * 4 + met.back().size() * 8);
    copy.nodes.resize(words);
    copy.leaf_blocks.resize(met.back().size());
    for (std::size_t level = 0; level < leaf_level; ++level)
      copy_nodes(met[level], level + 1 == leaf_level ? blocks_ : nodes_, copy.nodes.data());
    polled_for(met.back().size(), kGrain, work_, "leaf blocks",
               [&](std::size_t i) { copy.leaf_blocks[i] = dag_.leaf_blocks[met.back()[i]]; });
    return copy;
  }

 private:
  /// Nodes and the places of their children are loaded this many nodes ahead.
  static constexpr std::size_t kAhead = 16;
  static constexpr std::size_t kGrain = 1 << 14;

  std::uint64_t words_at(std::uint32_t node) const {
    return static_cast<std::uint64_t>(words_of_node(dag_.nodes + node));
  }

  /// Gives places to the children of the nodes of a level that were not met before. `words` is the
  /// number of words of all nodes that were met.
  void meet_below(const CountedVector<std::uint32_t>& nodes, bool are_blocks, std::uint64_t& words,
                  CountedVector<std::uint32_t>& below) {
    std::uint32_t* const places = (are_blocks ? blocks_ : nodes_).data();
    const auto for_each_child = [&](std::size_t i, const auto& use) {
      if (i >= nodes.size()) return;
      const std::uint32_t* const node = dag_.nodes + nodes[i];
      for (int k = 1; k < words_of_node(node); ++k) use(node[k]);
    };
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      work_.poll_seldom(i);
      if (i + 2 * kAhead < nodes.size()) __builtin_prefetch(dag_.nodes + nodes[i + 2 * kAhead]);
      for_each_child(i + kAhead, [&](std::uint32_t child) {
        __builtin_prefetch(places + child, 1);
        if (!are_blocks) __builtin_prefetch(dag_.nodes + child);
      });
      for_each_child(i, [&](std::uint32_t child) {
        if (places[child] != 0) return;
        if (words + 9 > kMaxPlainWords)
          throw Error(
              "the DAG is too large: its nodes have more words than 32-bit pointers can address");
        places[child] = static_cast<std::uint32_t>(are_blocks ? below.size() : words) + 1;
        below.push_back(child);
        if (!are_blocks) words += words_at(child);
      });
    }
  }

  /// Copies the nodes of a level to their places, with the places of their children.
  void copy_nodes(const CountedVector<std::uint32_t>& nodes, const PageVector<std::uint32_t>& below,
                  std::uint32_t* words) const {
    polled_for(nodes.size(), kGrain, work_, "nodes", [&](std::size_t i) {
      const std::uint32_t* const node = dag_.nodes + nodes[i];
      std::uint32_t* const to = words + nodes_[nodes[i]] - 1;
      to[0] = child_mask(node);
      for (int k = 1; k < words_of_node(node); ++k) to[k] = below[node[k]] - 1;
    });
  }

  SvdagView dag_;
  Work work_;
  MemoryReservation bytes_;
  /// For each node (by its word) and each leaf block that was met: its place in the copy, plus 1.
  PageVector<std::uint32_t> nodes_, blocks_;
};

}  // namespace

Svdag canonical_copy(const SvdagView& dag, std::uint64_t words_end, Work work) {
  Svdag empty;
  empty.levels = dag.levels;
  return dag.is_empty() ? empty : CanonicalCopy(dag, words_end, work).run();
}

}  // namespace voxdag
