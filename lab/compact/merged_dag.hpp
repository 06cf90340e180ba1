#pragma once
/// Merges the nodes of a DAG that are images of each other under symmetries of the cube.
///
/// Alberto Jaspe Villanueva, Fabio Marton and Enrico Gobbetti: SSVDAGs: Symmetry-aware Sparse Voxel
/// DAGs, I3D 2016 (mirrors); Mathijs Molenaar and Elmar Eisemann: Transform-Aware Sparse Voxel
/// Directed Acyclic Graphs, I3D 2025 (all 48 symmetries).
///
/// From the leaves up, a node becomes a list of pairs of a representative of the level below and
/// the symmetry that makes the child of it. Two nodes merge if a symmetry moves and changes the
/// pairs of one into those of the other. A representative may be its own image under some
/// symmetries, its invariances; two pairs are equal if they differ by one of these.
#include <array>
#include <cstdint>
#include <vector>

#include "lab/compact/dag_nodes.hpp"
#include "voxdag/core/parallel/progress.hpp"

namespace voxdag::lab {

/// The image of a representative under a symmetry (symmetry.hpp).
struct MergedChild {
  std::uint32_t node = kNoNode;
  std::uint8_t symmetry = 0;

  friend bool operator==(const MergedChild&, const MergedChild&) = default;
};

using MergedNode = std::array<MergedChild, 8>;

enum class MergeRule {
  /// Mirrors. Pairs are equal if they differ by mirrors of single axes that are invariances: a
  /// representative that only a mirror of two or three axes at once leaves alone counts as one
  /// without invariances. Molenaar and Eisemann state this as the rule of SSVDAGs.
  kPublishedMirrors,
  kMirrors,     ///< Mirrors, with all invariances.
  kSymmetries,  ///< All 48 symmetries, with all invariances.
};

struct MergedDag {
  /// The representatives of levels 0..L-3, in the order in which the DAG has them.
  std::vector<std::vector<MergedNode>> nodes;
  /// The representatives of level L-2.
  std::vector<std::uint64_t> leaf_blocks;
  /// For each node of the DAG, of levels 0..L-2: the image that it is. Representatives are images
  /// under the identity.
  std::vector<std::vector<MergedChild>> image;
};

/// Merges a DAG that is not empty. Throws Cancelled.
MergedDag merge_nodes(const DagNodes& dag, MergeRule rule, const Progress& progress);

}  // namespace voxdag::lab
