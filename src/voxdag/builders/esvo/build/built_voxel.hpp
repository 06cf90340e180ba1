#pragma once
/// A finished voxel with the part of the octree below it.
#include <optional>
#include <span>

#include "voxdag/builders/esvo/build/decide_cell.hpp"
#include "voxdag/builders/esvo/encode/esvo_tree.hpp"
#include "voxdag/builders/pieces/surface_sum.hpp"
#include "voxdag/core/memory_budget.hpp"

namespace voxdag {

struct BuiltVoxel {
  bool exists = false;  ///< False without any surface that passes the alpha test.
  bool is_leaf = false;
  std::optional<Contour> contour;
  SurfaceSum sum;
  EsvoTree tree;             ///< Node 0 is the voxel; empty if the voxel is a leaf.
  MemoryReservation memory;  ///< Memory of the tree.

  /// Counts the tree in a budget. Throws OverMemory.
  void count_tree(MemoryBudget* budget);
};

/// Joins the eight children of a voxel, in order, to the voxel. Consumes the children. Counts the
/// tree in `budget`. Throws OverMemory.
BuiltVoxel join_children(const CellDecision& decision, std::span<BuiltVoxel, 8> children,
                         bool attributes, MemoryBudget* budget = nullptr);

/// Reduces a tree to its node 0 after everything below it was packed into blocks. `first_child` is
/// the slot of the first child's descriptor.
void keep_packed_root(EsvoTree& tree, std::uint64_t first_child);

}  // namespace voxdag
