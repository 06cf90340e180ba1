#include "voxdag/stored/svdag/svdag_counts.hpp"

#include <bitset>
#include <numeric>

namespace voxdag {

std::uint64_t SvdagCounts::svo_nodes() const {
  return std::accumulate(svo_nodes_per_level.begin(), svo_nodes_per_level.end(), std::uint64_t{0});
}

std::uint64_t SvdagCounts::dag_nodes() const {
  return std::accumulate(dag_nodes_per_level.begin(), dag_nodes_per_level.end(), std::uint64_t{0});
}

namespace {

template <class Dag>
SvdagCounts count(const Dag& dag) {
  const int levels = dag.levels;
  SvdagCounts counts;
  counts.svo_nodes_per_level.resize(levels);
  counts.dag_nodes_per_level.resize(levels);
  if (dag.is_empty()) return counts;

  constexpr std::uint64_t kAhead = 24;
  // paths[p / 2] is the number of octree nodes that the DAG node at word p of the current level
  // represents; a node has at least two words. For leaf blocks it is paths[p].
  std::vector<std::uint64_t> paths{1}, below;
  for (int level = 0; level < levels - 2; ++level) {
    const std::uint64_t begin = dag.level_begin[level], end = dag.level_begin[level + 1];
    const bool above_leaf_blocks = level + 1 == levels - 2;
    const std::uint64_t base = pointer_base(dag, level);
    const int shift = above_leaf_blocks ? 0 : 1;
    below.assign(above_leaf_blocks ? dag.leaf_block_count : (dag.level_begin[level + 2] - end) / 2,
                 0);
    for (std::uint64_t at = begin; at < end;) {
      const std::uint32_t* node = dag.nodes + at;
      const std::uint64_t paths_here = paths[(at - begin) / 2];
      const int children = popcount(child_mask(node));
      for_each_child_place(dag, level, at, [&](std::uint64_t, std::uint64_t place) {
        below[place >> shift] += paths_here;
      });
      // Prefetches the sums, which are scattered over the next level. Words that are masks are
      // harmless.
      for (int i = 1; i <= children && at + i + kAhead < end; ++i)
        if (const std::uint64_t sum = (node[i + kAhead] - base) >> shift; sum < below.size())
          __builtin_prefetch(&below[sum], 1);
      counts.svo_nodes_per_level[level] += paths_here;
      ++counts.dag_nodes_per_level[level];
      at += 1 + children;
    }
    paths.swap(below);
  }

  std::bitset<256> unique_octants;
  counts.dag_nodes_per_level[levels - 2] = dag.leaf_block_count;
  for (std::uint64_t i = 0; i < dag.leaf_block_count; ++i) {
    const std::uint64_t block = dag.leaf_blocks[i];
    counts.svo_nodes_per_level[levels - 2] += paths[i];
    counts.svo_nodes_per_level[levels - 1] += paths[i] * popcount(leaf_block_child_mask(block));
    counts.voxels += paths[i] * popcount64(block);
    for (int octant = 0; octant < 8; ++octant) unique_octants.set((block >> (8 * octant)) & 0xFF);
  }
  unique_octants.reset(0);
  counts.dag_nodes_per_level[levels - 1] = unique_octants.count();
  return counts;
}

}  // namespace

SvdagCounts count_svdag(const SvdagView& dag) { return count(dag); }
SvdagCounts count_svdag(const LongSvdagView& dag) { return count(dag); }

}  // namespace voxdag
