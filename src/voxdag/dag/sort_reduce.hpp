#pragma once
/// The reduction of an octree, or of several partly reduced ones, to the minimal DAG by sorting.
///
/// Source: Kämpe, Sintorn, Assarsson, "High Resolution Sparse Voxel DAGs", SIGGRAPH 2013,
/// Section 3. Bottom-up, one level at a time: sort the nodes with their child pointers as the key,
/// compact the sorted list to its unique nodes while a table of indirections notes where each node
/// went, and rewrite the pointers of the level above.
#include "voxdag/dag/sort_tree.hpp"
#include "voxdag/parallel/progress.hpp"

namespace voxdag {

/// Seconds summed over the threads that did the work.
struct SortTimes {
  double reduce = 0;  ///< The whole reduction, sorting included.
  double sort = 0;
};

/// Merges all equal nodes, level by level. The nodes of level 0 are merged only if `merge_roots`
/// is set; otherwise the roots keep their indices. `parallel`: sort on all threads. `progress` may
/// be null. Throws OverMemory and Cancelled; the tree is then useless.
void reduce_by_sorting(SortTree& tree, bool merge_roots, bool parallel, SortTimes& times,
                       MemoryBudget& budget, const Progress* progress);

}  // namespace voxdag
