#pragma once
/// The ray cast of cast.hpp at a DAG with a dense grid above it (stored/svdag/top_grid.hpp): the
/// same cells for every ray, to the bit, in fewer steps, and in steps that can be interleaved with
/// those of other rays.
///
/// The plane rule (grid_ray.hpp) defines the cell that a ray is in at any T. So a ray in an empty
/// cube of the grid goes to the T at which it leaves the cube, and finds its cell there by the same
/// rule. In a cell with voxels it walks the nodes below, until a step leaves the cell.
#include <type_traits>

#include "voxdag/stored/svdag/top_grid.hpp"
#include "voxdag/trace/cast.hpp"
#include "voxdag/trace/svdag_nodes.hpp"

namespace voxdag {

/// The node layout for rays at a DAG with its grid. A grid of level 0 has no cells: then rays walk
/// the nodes alone.
class TopNodes : public SvdagNodes {
 public:
  VOXDAG_HD TopNodes(const SvdagView& dag, const TopGridView& top) : SvdagNodes(dag), top_(top) {}

  VOXDAG_HD const TopGridView& top() const { return top_; }

 private:
  TopGridView top_;
};

/// A ray on its way. The caller owns the stack, as for the other walks.
class TopWalk {
 public:
  using Entry = SvdagPath::Entry;
  enum class State { kRuns, kHits, kMisses };

  TopWalk() = default;
  /// Starts the walk of a ray for which can_walk() is true. The ray may end at cells of level
  /// `first_stop` and finer ones. If the grid's cells are among them, the walk does without the
  /// grid.
  VOXDAG_HD TopWalk(const TopNodes& nodes, const GridRay& ray, int first_stop)
      : cell_(ray, ray.t_min), path_(nodes), t_(ray.t_min) {
    const int level = nodes.top().level;
    if (first_stop <= level || level == 0) return;
    top_bit_ = kRootBit - level;
    for (int axis = 0; axis < 3; ++axis) way_[axis] = 1 / ray.inverse[axis];
    cell_.jump(t_, top_bit_, way_);
  }

  /// Visits the next cell, as cast() does. Nodes are TopNodes, which may count steps and bytes.
  template <class Nodes, class Stop>
  VOXDAG_HD State step(const Nodes& nodes, const GridRay& ray, const Stop& stop, Entry* stack,
                       CellHit& hit) {
    if constexpr (requires { nodes.on_step(); }) nodes.on_step();
    if (cell_.bit() == top_bit_) {
      if constexpr (requires { nodes.on_read(0u); }) nodes.on_read(8);
      const std::uint64_t cell = nodes.top().cells[top_index(ray.mirrored)];
      if (TopGridView::is_empty(cell)) {
        // A ray runs up the axes that are mirrored, so these bits are its octant.
        const float t = cell_.exit_of_cube(TopGridView::free_way(cell, ray.mirrored));
        if (t > ray.t_max) return State::kMisses;
        t_ = t;
        return cell_.jump(t, top_bit_, way_) ? State::kRuns : State::kMisses;
      }
      path_.start(TopGridView::node(cell), kRootBit - top_bit_);
      count_node(nodes, kRootBit - top_bit_);
      cell_.push(t_);
    }
    const CellWalk::Exit exit = cell_.exit();
    const std::uint32_t index = cell_.child() ^ ray.mirrored;
    if ((path_.mask() >> index & 1u) != 0) {
      const int level = cell_.level();
      if (level == nodes.levels() || stop(level, t_, exit.t)) {
        hit = {t_, cell_.x(), cell_.y(), cell_.z(), level};
        return State::kHits;
      }
      path_.push(stack, level, index);
      count_node(nodes, level);
      cell_.push(t_);
      return State::kRuns;
    }
    if (exit.t > ray.t_max) return State::kMisses;
    t_ = exit.t;
    if (cell_.advance(exit)) return State::kRuns;
    if (cell_.has_left(kRootBit)) return State::kMisses;
    if (cell_.has_left(top_bit_)) {
      cell_.rise(top_bit_);
    } else {
      cell_.pop();
      path_.pop(stack, cell_.level());
    }
    return State::kRuns;
  }

 private:
  static constexpr int kRootBit = 23;  ///< The root has the size 1 << kRootBit.

  /// Counts the bytes of a pointer and of what it leads to.
  template <class Nodes>
  VOXDAG_HD static void count_node(const Nodes& nodes, int level) {
    if constexpr (requires { nodes.on_read(0u); })
      nodes.on_read(level < nodes.levels() - 2 ? 8u : level == nodes.levels() - 2 ? 12u : 0u);
  }

  /// Returns the index of the walk's cell in the grid.
  VOXDAG_HD std::size_t top_index(std::uint32_t mirrored) const {
    const int level = kRootBit - top_bit_;
    const std::uint32_t last = (1u << level) - 1;
    const auto at = [&](std::uint32_t position, int axis) {
      return (position >> top_bit_ & last) ^ ((mirrored >> axis & 1u) != 0 ? last : 0u);
    };
    return at(cell_.x(), 0) | at(cell_.y(), 1) << level |
           static_cast<std::size_t>(at(cell_.z(), 2)) << (2 * level);
  }

  CellWalk cell_;
  SvdagPath path_;
  float t_ = 0;
  float way_[3] = {};       ///< How far the ray moves on each axis while T grows by 1.
  int top_bit_ = kRootBit;  ///< Cells of the grid have the size 1 << top_bit_; kRootBit: no grid.
};

/// Returns whether a TopWalk may start: the DAG has voxels, and the ray is in the grid at its
/// t_min.
VOXDAG_HD inline bool can_walk(const SvdagNodes& nodes, const GridRay& ray) {
  return !ray.misses() && !nodes.is_empty() && ray.exit_t() > ray.t_min;
}

/// Casts a ray like cast() in cast.hpp. `stop` must have first_level(): the coarsest level at which
/// it can be true.
template <class Nodes, class Stop>
requires std::is_base_of_v<TopNodes, Nodes> VOXDAG_HD inline bool cast(const Nodes& nodes,
                                                                       const GridRay& ray,
                                                                       const Stop& stop,
                                                                       CellHit& hit) {
  if (!can_walk(nodes, ray)) return false;
  TopWalk::Entry stack[kMaxLevels];
  TopWalk walk(nodes, ray, stop.first_level());
  for (;;) {
    const TopWalk::State state = walk.step(nodes, ray, stop, stack, hit);
    if (state != TopWalk::State::kRuns) return state == TopWalk::State::kHits;
  }
}

}  // namespace voxdag
