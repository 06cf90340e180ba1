#pragma once
/// The reduction of an octree, or of several partly reduced ones, to the minimal DAG by sorting.
///
/// Source: Kämpe, Sintorn, Assarsson, "High Resolution Sparse Voxel DAGs", SIGGRAPH 2013,
/// Section 3. Bottom-up, one level at a time: sort the nodes with their child pointers as the key,
/// compact the sorted list to its unique nodes while a table of indirections notes where each node
/// went, and rewrite the pointers of the level above.
#include <array>
#include <cstdint>
#include <vector>

#include "voxdag/dag/node_store.hpp"

namespace voxdag {

/// A node as its key: the pointer of each child, kNoNode where there is none; 256 bits.
using SortNode = std::array<std::uint32_t, 8>;

/// Nodes by level, pointers being indices into the level below. Levels are relative to its root.
struct SortTree {
  std::vector<std::vector<SortNode>> levels;
  std::vector<std::uint64_t> leaf_blocks;  ///< Below the last of `levels`.

  std::uint64_t bytes() const;
};

/// Seconds summed over the threads that did the work.
struct SortTimes {
  double reduce = 0;  ///< Everything, sorting included.
  double sort = 0;
};

/// Merges all equal nodes, level by level. The nodes of level 0 are merged only if `merge_roots`
/// is set; else the roots keep their places. `parallel`: sort on all threads.
void reduce_by_sorting(SortTree& tree, bool merge_roots, bool parallel, SortTimes& times);

}  // namespace voxdag
