#pragma once
/// The reduction of an octree, or of several partly reduced ones, to the minimal DAG by sorting.
///
/// Source: Kämpe, Sintorn, Assarsson, "High Resolution Sparse Voxel DAGs", SIGGRAPH 2013, Section
/// 3. Works bottom-up, one level at a time. Sorts the nodes with their child pointers as the key,
/// compacts the sorted list to its unique nodes, records in a table of indirections where each node
/// went, and rewrites the pointers of the level above.
#include "voxdag/builders/dag/sort_tree.hpp"
#include "voxdag/core/parallel/work.hpp"

namespace voxdag {

/// Wall-clock seconds of the thread that called.
struct SortTimes {
  double reduce = 0;  ///< The whole reduction, with sorting.
  double sort = 0;
};

/// Merges all equal nodes, level by level. The nodes of level 0 are merged only if `merge_roots` is
/// set; otherwise the roots keep their indices. `parallel`: sort on all threads. Throws OverMemory
/// and Cancelled; the tree is then unusable.
void reduce_by_sorting(SortTree& tree, bool merge_roots, bool parallel, SortTimes& times,
                       Work work);

}  // namespace voxdag
