#pragma once
/// Converts unique nodes in any order to the canonical Svdag.
///
/// Source of the idea: C. J. Cheney, "A nonrecursive list compacting algorithm", CACM 1970. Nodes
/// are copied breadth-first, level by level, and a node is placed when it is first met. In each
/// level this gives the order in which a depth-first walk first visits the nodes, because both
/// orders sort the nodes by their least Morton path.
#include <algorithm>
#include <cstdint>

#include "voxdag/core/error.hpp"
#include "voxdag/core/memory_budget.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

/// `source` has
///   const std::uint32_t* words(level, id)    returns the words of a node above the leaf blocks
///   std::uint64_t leaf_block(id)
///   std::uint32_t& forward(level, id)        returns a word to write to, at first below 256, for
///                                            each node and leaf block: the mask of a node will do
///   void prefetch(level, id)                 starts loading them; ids may be any numbers
///   void release(level)                      frees a level that is not needed any more
///   std::uint64_t node_words(), leaf_blocks()  return upper bounds for what is reachable
/// The children of level l-1 are ids of level l. `root` is of level 0. `work` counts the new DAG
/// until the call returns. Throws Error if the DAG outgrows 32-bit pointers, OverMemory and
/// Cancelled.
template <class Source>
Svdag canonical_order(Source& source, int levels, std::uint32_t root, Work work) {
  // The word of a placed node becomes its new place plus kPlaced, which is greater than any mask.
  constexpr std::uint64_t kPlaced = 256;
  Svdag dag;
  dag.levels = levels;
  const int leaf_level = levels - 2;
  if (std::max(source.node_words(), source.leaf_blocks()) + kPlaced > 0xFFFFFFFFull)
    throw Error("the DAG is too large: its nodes have more words than 32-bit pointers can address");
  const MemoryReservation copy(work.memory, source.node_words() * sizeof(std::uint32_t) +
                                                source.leaf_blocks() * sizeof(std::uint64_t));
  dag.nodes.reserve(source.node_words());
  dag.leaf_blocks.reserve(source.leaf_blocks());

  const auto place_leaf = [&](std::uint32_t id) {
    std::uint32_t& forward = source.forward(leaf_level, id);
    if (forward < kPlaced) {
      forward = static_cast<std::uint32_t>(dag.leaf_blocks.size() + kPlaced);
      dag.leaf_blocks.push_back(source.leaf_block(id));
    }
    return static_cast<std::uint32_t>(forward - kPlaced);
  };
  const auto place_node = [&](int level, std::uint32_t id) {
    std::uint32_t& forward = source.forward(level, id);
    if (forward < kPlaced) {
      const auto place = dag.nodes.size();
      const std::uint32_t* const words = source.words(level, id);
      dag.nodes.insert(dag.nodes.end(), words, words + words_of_node(words));
      forward = static_cast<std::uint32_t>(place + kPlaced);
    }
    return static_cast<std::uint32_t>(forward - kPlaced);
  };

  if (leaf_level == 0) {
    place_leaf(root);
  } else {
    place_node(0, root);
  }
  // The nodes of a level are scattered in memory. Their words are prefetched this many nodes ahead.
  constexpr std::uint64_t kAhead = 24;
  constexpr std::uint64_t kWordsPerPoll = 1 << 16;
  const auto all_words = static_cast<double>(dag.nodes.capacity());
  std::uint64_t next_poll = 0;
  for (int level = 0; level < leaf_level; ++level) {
    const std::uint64_t begin = dag.level_begin[level], end = dag.nodes.size();
    for (std::uint64_t at = begin; at < end;) {
      if (at >= next_poll) {
        work.poll();
        work.report("number", static_cast<double>(at) / all_words, at);
        next_poll = at + kWordsPerPoll;
      }
      const int children = popcount(dag.nodes[at]);
      for (std::uint64_t i = at + 1; i <= at + children; ++i) {
        if (i + kAhead < end) source.prefetch(level + 1, dag.nodes[i + kAhead]);
        const std::uint32_t id = dag.nodes[i];
        const std::uint32_t placed =
            level + 1 == leaf_level ? place_leaf(id) : place_node(level + 1, id);
        dag.nodes[i] = placed;
      }
      at += 1 + children;
    }
    source.release(level + 1);
    dag.level_begin[level + 1] = end;
  }
  for (int level = leaf_level; level <= kMaxLevels; ++level)
    dag.level_begin[level] = dag.nodes.size();
  return dag;
}

}  // namespace voxdag
