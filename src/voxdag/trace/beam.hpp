#pragma once
/// Beams: a bound on t for all rays from one point within a range of directions.
///
/// Sources: Laine and Karras, "Efficient Sparse Voxel Octrees", I3D 2010, section 4.2, who shorten
/// primary rays by a coarse distance image; Kämpe, Sintorn and Assarsson, "High Resolution Sparse
/// Voxel DAGs", SIGGRAPH 2013, section 4, who do so for shadow rays, from both ends. They cast the
/// corner rays of a beam, which is conservative only if no cell fits between these rays. Here the
/// beam itself is cast, by interval arithmetic. Its rays share an apex, and at the parameter t they
/// lie in the box [apex + t * lowest, apex + t * highest]. The box meets a cell in an interval of t
/// that has a closed form: each axis gives two inequalities that are linear in t. A depth-first
/// walk, nearest octants first, finds the least t at which the beam meets a non-empty cell. A walk
/// from the far end finds the greatest.
///
/// Why the bound holds for the rays of grid_ray.hpp. At any T such a ray differs from its exact
/// line, on each axis and in units of the grid's side, by at most 2^-24 (origin) + 2 * 2^-24
/// (plane_t rounds twice) + 2^-24 (t_min or t_max as a T) + 2^-32 (parallel axes): less than 2^-21.
/// Cells are widened by 2^-21; the rounding errors of the walk itself, in double, are far smaller.
/// The walk never descends below the cells at which a ray may end, and whenever a ray is in a cell,
/// its beam is in that cell too.
#include <cmath>

#include "voxdag/core/bits.hpp"
#include "voxdag/core/grid.hpp"
#include "voxdag/core/morton.hpp"
#include "voxdag/trace/esvo_nodes.hpp"

namespace voxdag {

/// A beam in units of the grid's side; the grid is [0,1]³. The apex may lie anywhere.
struct Beam {
  Vec3d apex{};
  Vec3d lowest{}, highest{};  ///< Bounds on the rays' directions, per axis.
  double t_min = 0, t_max = HUGE_VAL;
};

/// The size of the non-empty cells at which a beam's walk ends. They are small cells, where
/// descending gains little, and all cells at which a ray may end for its level of detail
/// (StopBelowSize compares a cell's side with the t at which the ray leaves it). The walk ends at a
/// cell whose side, in units of the grid's, is at most the maximum of at_start, per_enter * t and
/// per_exit * t:
struct BeamStop {
  double at_start = 0;
  double per_enter = 0;  ///< t: where the beam enters the cell
  double per_exit = 0;   ///< t: where the beam leaves the cell
};

/// The distance by which cells are widened, in units of the grid's side.
inline constexpr double kBeamSlack = 0x1p-21;

/// The two inequalities of one axis: t * lowest <= hi - apex and t * highest >= lo - apex.
struct BeamAxis {
  double apex = 0, inverse_lowest = 0, inverse_highest = 0;

  VOXDAG_HD static double inverse(double d, double instead) {
    // Replaces a bound of zero by one slightly farther out, so that the quotient is finite.
    return 1 / (std::fabs(d) < 1e-100 ? instead : d);
  }
  VOXDAG_HD static BeamAxis make(double apex, double lowest, double highest) {
    return {apex, inverse(lowest, -1e-100), inverse(highest, 1e-100)};
  }
  /// Narrows [enter, exit] to the t at which the beam overlaps [lo, hi].
  VOXDAG_HD void clip(double lo, double hi, double& enter, double& exit) const {
    const double below = (hi - apex) * inverse_lowest;
    const double above = (lo - apex) * inverse_highest;
    if (inverse_lowest > 0)
      exit = below < exit ? below : exit;
    else
      enter = below > enter ? below : enter;
    if (inverse_highest > 0)
      enter = above > enter ? above : enter;
    else
      exit = above < exit ? above : exit;
  }
};

/// Implements first_met() and last_met().
template <bool kFromEnd, class Nodes>
VOXDAG_HD inline bool cast_beam(const Nodes& nodes, const Beam& beam, const BeamStop& stop,
                                double& bound) {
  if (nodes.is_empty() || !(beam.t_min <= beam.t_max)) return false;
  struct Entry {
    typename Nodes::Node node;
    Vec3i cell;             // in cells of the node's level
    std::uint32_t pending;  // children still to visit, as index ^ order
  };
  Entry stack[kMaxLevels];
  BeamAxis axes[3];
  std::uint32_t order = 0;  // the octant that the beam enters first
  for (int axis = 0; axis < 3; ++axis) {
    axes[axis] = BeamAxis::make(beam.apex[axis], beam.lowest[axis], beam.highest[axis]);
    const bool is_down = beam.lowest[axis] + beam.highest[axis] < 0;
    order |= is_down != kFromEnd ? 1u << axis : 0u;
  }
  const auto reordered = [order](std::uint32_t mask) {
    if ((order & 1u) != 0) mask = (mask & 0x55u) << 1 | (mask >> 1 & 0x55u);
    if ((order & 2u) != 0) mask = (mask & 0x33u) << 2 | (mask >> 2 & 0x33u);
    if ((order & 4u) != 0) mask = (mask & 0x0Fu) << 4 | mask >> 4;
    return mask;
  };
  bool is_met = false;
  double first = beam.t_min, last = beam.t_max;  // the t at which a better bound may lie
  int level = 0;
  stack[0] = {nodes.root(), {}, reordered(nodes.child_mask(nodes.root(), 0))};
  for (;;) {
    if constexpr (requires { nodes.on_step(); }) nodes.on_step();
    Entry& top = stack[level];
    if (top.pending == 0) {
      if (level == 0) break;
      --level;
      continue;
    }
    const auto index = static_cast<std::uint32_t>(lowest_bit64(top.pending)) ^ order;
    top.pending &= top.pending - 1;
    const Vec3i cell = top.cell * 2 + child_offset(static_cast<int>(index));
    const double side =
        static_cast<double>(float_from_bits(static_cast<std::uint32_t>(127 - (level + 1)) << 23));
    double enter = first, exit = last;
    for (int axis = 0; axis < 3; ++axis) {
      const double lo = cell[axis] * side;
      axes[axis].clip(lo - kBeamSlack, lo + side + kBeamSlack, enter, exit);
    }
    if (!(enter <= exit)) continue;
    // `first` or `last` is the best bound so far; a cell must improve it.
    if (is_met && (kFromEnd ? exit <= first : enter >= last)) continue;
    double leave = exit;
    if (!kFromEnd && stop.per_exit > 0) {
      double unused = first;
      leave = HUGE_VAL;
      for (int axis = 0; axis < 3; ++axis) {
        const double lo = cell[axis] * side;
        axes[axis].clip(lo - kBeamSlack, lo + side + kBeamSlack, unused, leave);
      }
    }
    if (is_leaf_child(nodes, top.node, level, static_cast<int>(index)) || side <= stop.at_start ||
        side <= stop.per_enter * enter || side <= stop.per_exit * leave) {
      is_met = true;
      if (kFromEnd)
        first = exit;
      else
        last = enter;
      continue;
    }
    const auto child = nodes.child(top.node, level, static_cast<int>(index));
    ++level;
    stack[level] = {child, cell, reordered(nodes.child_mask(child, level))};
  }
  if (is_met) bound = kFromEnd ? first : last;
  return is_met;
}

/// Returns whether any ray of the beam can meet a non-empty cell within [t_min, t_max]. If so, sets
/// `bound` to a t before which no ray does.
template <class Nodes>
VOXDAG_HD inline bool first_met(const Nodes& nodes, const Beam& beam, const BeamStop& stop,
                                double& bound) {
  return cast_beam<false>(nodes, beam, stop, bound);
}

/// Returns whether any ray of the beam can meet a non-empty cell within [t_min, t_max]. If so, sets
/// `bound` to a t after which no ray meets one.
template <class Nodes>
VOXDAG_HD inline bool last_met(const Nodes& nodes, const Beam& beam, const BeamStop& stop,
                               double& bound) {
  return cast_beam<true>(nodes, beam, stop, bound);
}

}  // namespace voxdag
