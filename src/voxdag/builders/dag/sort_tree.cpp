#include "voxdag/builders/dag/sort_tree.hpp"

#include <algorithm>

#include "voxdag/builders/dag/stop_watch.hpp"
#include "voxdag/core/parallel/polled_sort.hpp"

namespace voxdag {
namespace {

using Indirections = PageVector<std::uint32_t>;

/// Sorts `nodes` and removes duplicates. Returns the new index of every old index.
template <class Key>
Indirections sort_and_compact(PageVector<Key>& nodes, bool parallel, SortTimes& times, Work work) {
  struct Entry {
    Key key;
    std::uint32_t index;
  };
  PageVector<Entry> entries(work.memory);
  entries.resize(nodes.size());
  for (std::uint32_t i = 0; i < entries.size(); ++i) {
    work.poll_seldom(i);
    entries[i] = {nodes[i], i};
  }
  const auto by_key = [](const Entry& a, const Entry& b) { return a.key < b.key; };
  StopWatch watch;
  if (parallel)
    polled_sort(entries.begin(), entries.end(), work, by_key);
  else
    std::sort(entries.begin(), entries.end(), [&](const Entry& a, const Entry& b) {
      work.poll();
      return by_key(a, b);
    });
  times.sort += watch.lap();

  Indirections indirections(work.memory);
  indirections.resize(nodes.size());
  std::size_t unique = 0;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    work.poll_seldom(i);
    const Entry& entry = entries[i];
    if (unique == 0 || nodes[unique - 1] != entry.key) nodes[unique++] = entry.key;
    indirections[entry.index] = static_cast<std::uint32_t>(unique - 1);
  }
  nodes.resize(unique);
  nodes.shrink_to_fit();
  return indirections;
}

void rewrite_pointers(PageVector<SortNode>& parents, const Indirections& indirections, Work work) {
  for (std::size_t i = 0; i < parents.size(); ++i) {
    work.poll_seldom(i);
    for (std::uint32_t& pointer : parents[i])
      if (pointer != kNoNode) pointer = indirections[pointer];
  }
}

}  // namespace

void reduce_by_sorting(SortTree& tree, bool merge_roots, bool parallel, SortTimes& times,
                       Work work) {
  StopWatch watch;
  if (!tree.levels.empty() || merge_roots) {
    const Indirections indirections = sort_and_compact(tree.leaf_blocks, parallel, times, work);
    if (!tree.levels.empty()) rewrite_pointers(tree.levels.back(), indirections, work);
  }
  for (std::size_t level = tree.levels.size(); level-- > (merge_roots ? 0 : 1);) {
    const Indirections indirections = sort_and_compact(tree.levels[level], parallel, times, work);
    if (level > 0) rewrite_pointers(tree.levels[level - 1], indirections, work);
  }
  times.reduce += watch.lap();
}

}  // namespace voxdag
