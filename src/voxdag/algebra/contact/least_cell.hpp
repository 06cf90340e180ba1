#pragma once
/// The voxel, or the empty place, of a DAG with the least cost: branch and bound.
///
/// Source of the idea: N. Roussopoulos, S. Kelley, F. Vincent, "Nearest Neighbor Queries", 1995. A
/// walk goes depth first to the child with the least bound, and leaves out those whose bound is not
/// below the best cost so far.
#include <limits>

#include "voxdag/core/morton.hpp"
#include "voxdag/core/vec.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

inline constexpr double kNoCost = std::numeric_limits<double>::infinity();

/// The cells among which LeastCell chooses.
enum class CellKind {
  kVoxels,
  kEmpty  ///< Empty places of the grid: cubes of 1, 2, 4... voxels a side.
};

/// Which of several cells with the least cost counts.
enum class Ties {
  kFirst,  ///< The one with the least x, then y, then z.
  kAny     ///< The one that the walk meets first: faster, and equal on every machine.
};

/// Finds the cell with the least cost. `Cost` is a type with
///   bound(first, side, most)   at most the cost of every cell in a cube, in voxels; kNoCost if
///   that
///                              is above `most`
///   exact(first, side, most)   the cost of a cell that is looked for
/// Takes a view that has a root of its own (SvdagView::root), which has voxels.
template <CellKind kKind, Ties kTies, class Cost>
class LeastCell {
 public:
  /// Finds cells of a cost of at most `most`.
  LeastCell(const SvdagView& dag, const Cost& cost, double most)
      : dag_(dag), cost_(cost), least_(most) {
    if (!is_beaten(cost_.bound(Vec3i{}, std::int32_t{1} << dag.levels, most)))
      visit(0, dag.root, Vec3i{});
  }

  bool is_found() const { return side_ != 0; }
  double cost() const { return least_; }
  Vec3i first() const { return first_; }       ///< The least corner of the cell.
  std::int32_t side() const { return side_; }  ///< In voxels.

 private:
  struct Child {
    double bound;
    std::uint32_t at;
    Vec3i first;
  };

  bool is_beaten(double cost) const {
    if (kTies == Ties::kAny && is_found()) return cost >= least_;
    return cost == kNoCost || !(cost <= least_);
  }

  /// `at` is the word of a node, the number of a leaf block, or in it the mask of 2³ voxels.
  void visit(int level, std::uint32_t at, Vec3i first) {
    const int above_voxels = dag_.levels - level - 1;
    const std::int32_t side = std::int32_t{1} << above_voxels;
    const std::uint64_t block = above_voxels == 1 ? dag_.leaf_blocks[at] : 0;
    const std::uint32_t mask = above_voxels > 1    ? child_mask(dag_.nodes + at)
                               : above_voxels == 1 ? leaf_block_child_mask(block)
                                                   : at;
    Child children[8];
    int count = 0;
    for (int i = 0; i < 8; ++i) {
      const bool has_voxels = (mask >> i & 1) != 0;
      const Vec3i begin = first + child_offset(i) * side;
      if (kKind == CellKind::kEmpty ? !has_voxels : has_voxels && above_voxels == 0) {
        offer(begin, side);
        continue;
      }
      if (!has_voxels || above_voxels == 0) continue;
      const std::uint32_t child = above_voxels > 1
                                      ? child_pointer(dag_.nodes + at, i)
                                      : static_cast<std::uint32_t>(block >> 8 * i) & 0xFF;
      if (kKind == CellKind::kEmpty && is_full(level + 1, child)) continue;
      const double bound = cost_.bound(begin, side, least_);
      if (is_beaten(bound)) continue;
      int place = count++;
      for (; place > 0 && children[place - 1].bound > bound; --place)
        children[place] = children[place - 1];
      children[place] = {bound, child, begin};
    }
    for (int i = 0; i < count && !is_beaten(children[i].bound); ++i)
      visit(level + 1, children[i].at, children[i].first);
  }

  void offer(Vec3i first, std::int32_t side) {
    const double cost = cost_.exact(first, side, least_);
    if (is_beaten(cost) || (is_found() && cost == least_ && !is_before(first, first_))) return;
    least_ = cost;
    first_ = first;
    side_ = side;
  }

  /// Returns whether all places of a node are voxels; in canonical DAGs, there is one such node of
  /// each level, so that all children are equal. Where an edit made more, walks descend into them.
  bool is_full(int level, std::uint32_t at) const {
    for (; level < dag_.levels - 2; ++level) {
      const std::uint32_t* const node = dag_.nodes + at;
      if (child_mask(node) != 0xFF) return false;
      for (int i = 2; i <= 8; ++i)
        if (node[i] != node[1]) return false;
      at = node[1];
    }
    return level == dag_.levels - 2 ? dag_.leaf_blocks[at] == ~std::uint64_t{0} : at == 0xFF;
  }

  const SvdagView& dag_;
  const Cost& cost_;
  double least_;
  Vec3i first_;
  std::int32_t side_ = 0;
};

}  // namespace voxdag
