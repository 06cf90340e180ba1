#pragma once
/// Finds equal subtrees of several DAGs.
#include <deque>
#include <vector>

#include "voxdag/stored/attributes/numbered_cell.hpp"
#include "voxdag/stored/svdag/unique_cells.hpp"

namespace voxdag {

/// Says which cells of a DAG, above a level m, have equal subtrees.
class NodeClasses {
 public:
  explicit NodeClasses(MemoryBudget* memory) : words_(memory), blocks_(memory) {}

  /// Returns the class of a cell of a level above m.
  std::uint32_t of(const SvdagView& dag, const NumberedCell& cell) const {
    if (cell.level == dag.levels - 1) return cell.octant;
    return cell.level < dag.levels - 2 ? words_[cell.at] : blocks_[cell.at];
  }

 private:
  friend class EqualNodes;
  CountedVector<std::uint32_t> words_, blocks_;  ///< By NumberedCell::at.
};

/// Gives equal numbers to nodes that have equal cells down to the finest level with attributes.
class EqualNodes {
 public:
  explicit EqualNodes(MemoryBudget* memory) : memory_(memory) {}

  /// Returns the classes of a valid DAG. The cells of its level `finest` have as many voxels as
  /// those of the other DAGs. Two nodes have equal classes if their cells have equally many voxels
  /// a side and the octrees below them are equal down to these levels. O(DAG) time and memory.
  /// Throws OverMemory.
  NodeClasses add(const SvdagView& dag, int finest);

 private:
  MemoryBudget* memory_;
  std::deque<UniqueNodes> nodes_;  ///< Of the cells with 2^i voxels a side, by i - 2.
};

}  // namespace voxdag
