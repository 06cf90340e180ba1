#pragma once
/// The voxel, or the empty place, of a DAG with the least cost: branch and bound.
///
/// Source of the idea: N. Roussopoulos, S. Kelley, F. Vincent, "Nearest Neighbor Queries", 1995. A
/// walk goes depth first to the child with the least bound, and leaves out those whose bound is not
/// below the best cost so far.
#include <bit>
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
///   near(first, side, most, cells, bounds)
///                                     sets bounds[i] for each child i of a cube of 2 sides: at
///                                     most the cost of every cell in it. Returns those of the
///                                     children in the mask `cells` whose bound is at most `most`
///   bound(first, side, bound, most)   a closer bound of one of them; kNoCost if it is above `most`
///   exact(first, side, bound, most)   the cost of a cell that is looked for
///   covers(first, side)               whether the cost of every cell in a cube is 0; may be absent
/// Takes a view that has a root of its own (SvdagView::root), which has voxels.
template <CellKind kKind, Ties kTies, class Cost>
class LeastCell {
 public:
  /// Finds cells of a cost of at most `most`.
  LeastCell(const SvdagView& dag, const Cost& cost, double most)
      : dag_(dag), cost_(cost), least_(most) {
    visit(0, dag.root, Vec3i{});
  }

  bool is_found() const { return side_ != 0; }
  double cost() const { return least_; }
  Vec3i first() const { return first_; }       ///< The least corner of the cell.
  std::int32_t side() const { return side_; }  ///< In voxels.

 private:
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
    double bounds[8];
    std::uint32_t near =
        cost_.near(first, side, least_, kKind == CellKind::kEmpty ? 0xFFu : mask, bounds);
    if (kKind == CellKind::kEmpty || above_voxels == 0) {
      const std::uint32_t sought = kKind == CellKind::kEmpty ? near & ~mask : near;
      for (std::uint32_t rest = sought; rest != 0; rest &= rest - 1) {
        const int i = std::countr_zero(rest);
        offer(first + child_offset(i) * side, side, bounds[i]);
      }
      if (above_voxels == 0) return;
      near ^= sought;
    }
    const auto child = [&](int i) {
      return above_voxels > 1 ? child_pointer(dag_.nodes + at, i)
                              : static_cast<std::uint32_t>(block >> 8 * i) & 0xFF;
    };
    for (std::uint32_t rest = near; rest != 0; rest &= rest - 1) {
      const int i = std::countr_zero(rest);
      bounds[i] = cost_.bound(first + child_offset(i) * side, side, bounds[i], least_);
      if (is_beaten(bounds[i]) || (kKind == CellKind::kEmpty && is_full(level + 1, child(i))))
        near ^= 1u << i;
    }
    while (near != 0) {
      int next = std::countr_zero(near);
      for (std::uint32_t rest = near & (near - 1); rest != 0; rest &= rest - 1)
        if (const int i = std::countr_zero(rest); bounds[i] < bounds[next]) next = i;
      if (is_beaten(bounds[next])) return;
      const Vec3i begin = first + child_offset(next) * side;
      if constexpr (requires { cost_.covers(begin, side); })
        if (cost_.covers(begin, side)) return take(begin, side, 0);
      visit(level + 1, child(next), begin);
      near ^= 1u << next;
    }
  }

  void offer(Vec3i first, std::int32_t side, double bound) {
    const double cost = cost_.exact(first, side, bound, least_);
    if (is_beaten(cost) || (is_found() && cost == least_ && !is_before(first, first_))) return;
    take(first, side, cost);
  }

  void take(Vec3i first, std::int32_t side, double cost) {
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
