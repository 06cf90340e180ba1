#include "voxdag/dag/sort_reduce.hpp"

#include <tbb/parallel_sort.h>

#include <algorithm>

#include "voxdag/dag/build_methods.hpp"

namespace voxdag {
namespace {

/// Sorts `nodes` and keeps one of each; returns for every old index the new one.
template <class Key>
std::vector<std::uint32_t> sort_and_compact(std::vector<Key>& nodes, bool parallel,
                                            SortTimes& times) {
  struct Entry {
    Key key;
    std::uint32_t index;
    bool operator<(const Entry& other) const { return key < other.key; }
  };
  std::vector<Entry> entries(nodes.size());
  for (std::uint32_t i = 0; i < entries.size(); ++i) entries[i] = {nodes[i], i};
  StopWatch watch;
  if (parallel)
    tbb::parallel_sort(entries.begin(), entries.end());
  else
    std::sort(entries.begin(), entries.end());
  times.sort += watch.lap();

  std::vector<std::uint32_t> indirections(nodes.size());
  std::size_t unique = 0;
  for (const Entry& entry : entries) {
    if (unique == 0 || nodes[unique - 1] != entry.key) nodes[unique++] = entry.key;
    indirections[entry.index] = static_cast<std::uint32_t>(unique - 1);
  }
  nodes.resize(unique);
  nodes.shrink_to_fit();
  return indirections;
}

void rewrite_pointers(std::vector<SortNode>& parents,
                      const std::vector<std::uint32_t>& indirections) {
  for (SortNode& parent : parents)
    for (std::uint32_t& pointer : parent)
      if (pointer != kNoNode) pointer = indirections[pointer];
}

}  // namespace

std::uint64_t SortTree::bytes() const {
  std::uint64_t bytes = leaf_blocks.size() * sizeof(std::uint64_t);
  for (const auto& level : levels) bytes += level.size() * sizeof(SortNode);
  return bytes;
}

void reduce_by_sorting(SortTree& tree, bool merge_roots, bool parallel, SortTimes& times) {
  StopWatch watch;
  if (!tree.levels.empty() || merge_roots) {
    const auto indirections = sort_and_compact(tree.leaf_blocks, parallel, times);
    if (!tree.levels.empty()) rewrite_pointers(tree.levels.back(), indirections);
  }
  for (std::size_t level = tree.levels.size(); level-- > (merge_roots ? 0 : 1);) {
    const auto indirections = sort_and_compact(tree.levels[level], parallel, times);
    if (level > 0) rewrite_pointers(tree.levels[level - 1], indirections);
  }
  times.reduce += watch.lap();
}

}  // namespace voxdag
