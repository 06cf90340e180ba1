#pragma once
/// Merges the nodes of a DAG that are moved images of each other.
///
/// Mathijs Molenaar and Elmar Eisemann: Transform-Aware Sparse Voxel Directed Acyclic Graphs, I3D
/// 2025. Above a height nodes merge by symmetries alone (merged_dag.hpp). The nodes of that height
/// and below merge by symmetries and moves, from the top down: of the nodes that are still needed,
/// those are kept of which any is made (translations.hpp), with the children that they have in the
/// DAG; the other nodes are pointers to them. A node that is made of a kept one may have itself
/// been kept for others: pointers make one step.
#include <cstdint>
#include <vector>

#include "lab/compact/dag_nodes.hpp"
#include "lab/compact/translations.hpp"
#include "voxdag/core/parallel/progress.hpp"

namespace voxdag::lab {

struct TransformedChild {
  std::uint32_t node = kNoNode;
  Transform transform;  ///< Makes the child from that node.

  friend bool operator==(const TransformedChild&, const TransformedChild&) = default;
};

using TransformedNode = std::array<TransformedChild, 8>;

struct TransformDag {
  int move_height = 0;  ///< Nodes of at most 2^move_height voxels a side may be moved; 0: none.
  std::vector<std::vector<TransformedNode>> nodes;  ///< Levels 0..L-3.
  std::vector<std::uint64_t> leaf_blocks;           ///< Level L-2.
};

/// Merges a DAG that is not empty. `move_height` is 0 (no moves), or 2 to 4 (nodes of 4³, 8³, 16³
/// voxels); it is less in the result if the grid is smaller. Throws Cancelled.
TransformDag merge_transformed(const DagNodes& dag, int move_height, const Progress& progress);

}  // namespace voxdag::lab
