// The walk of a packet of beams from one point. See cast_beam_packet.cpp for the algorithm.
// Included once for each instruction set.
#if defined(VOXDAG_BEAM_PACKET_WALK_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXDAG_BEAM_PACKET_WALK_INL
#undef VOXDAG_BEAM_PACKET_WALK_INL
#else
#define VOXDAG_BEAM_PACKET_WALK_INL
#endif

#include <cmath>

#include "voxdag/core/morton.hpp"
#include "voxdag/cpu/packets/beam_packet.hpp"
#include "voxdag/cpu/packets/packet_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace voxdag {
namespace HWY_NAMESPACE {

template <class Nodes>
class BeamPacketWalk : PacketLanes {
  using Beams = Set;
  /// A relative error larger than all rounding errors of float and of conversions to float.
  static constexpr float kRounding = 0x1p-20f;

 public:
  BeamPacketWalk(const Nodes& nodes, BeamPacket& packet) : nodes_(nodes), packet_(packet) {}

  void cast() {
    const DF d;
    for (std::size_t i = 0; i < packet_.size; i += kWidth)
      hn::Store(hn::Set(d, HUGE_VALF), d, packet_.first + i);
    if (nodes_.is_empty()) return;
    for (int axis = 0; axis < 3; ++axis) prepare(axis);
    walk();
  }

 private:
  /// The direction of all beams along an axis; kEither if they differ.
  enum class Way { kUp, kDown, kEither };

  struct Visit {
    typename Nodes::Node node;
    Vec3i cell;
    int level;
    Beams beams;
    float enter;  ///< No beam enters the cell before this t.
  };
  /// The beams that continue into each child, nearest child first, and a bound on the t at which
  /// they enter it.
  struct ChildBeams {
    Beams beams[8] = {};
    float enter[8];
  };
  /// Distances from the apex to the sides of the two slabs of children along an axis.
  struct Slabs {
    float low[2], high[2];
  };

  /// Prepares the factors of an axis. A beam overlaps [low, high], relative to the apex, while t *
  /// lowest <= high and t * highest >= low. The sign of `lowest` or `highest` decides whether the
  /// inequality gives the t at which the beam enters or the t at which it leaves.
  void prepare(int axis) {
    constexpr double kMin = 1e-30;
    const double* const lowest = packet_.lowest[axis];
    const double* const highest = packet_.highest[axis];
    bool is_up = true, is_down = true;
    for (std::size_t i = 0; i < packet_.size; ++i) {
      is_up = is_up && lowest[i] > kMin;
      is_down = is_down && highest[i] < -kMin;
    }
    ways_[axis] = is_up ? Way::kUp : is_down ? Way::kDown : Way::kEither;
    order_ |= is_down ? 1u << axis : 0u;
    for (std::size_t i = 0; i < (packet_.size + kWidth - 1) / kWidth * kWidth; ++i) {
      const std::size_t beam = i < packet_.size ? i : packet_.size - 1;
      double low = lowest[beam], high = highest[beam];
      if (ways_[axis] == Way::kEither) {
        low = low < -kMin ? low : -kMin;
        high = high > kMin ? high : kMin;
      }
      const auto by_low = static_cast<float>(1 / low), by_high = static_cast<float>(1 / high);
      enter_[axis][i] = (is_up ? by_high : by_low) * (1 - kRounding);
      leave_[axis][i] =
          (is_up ? by_low : by_high) * (is_up || is_down ? 1 + kRounding : 1 - kRounding);
    }
  }

  Slabs slabs_of(int axis, const Vec3i& cell, double side) const {
    Slabs slabs;
    for (int i = 0; i < 2; ++i) {
      const double low = (2 * cell[axis] + i) * side - packet_.apex[axis];
      slabs.low[i] = static_cast<float>(low - kBeamSlack);
      slabs.high[i] = static_cast<float>(low + side + kBeamSlack);
    }
    return slabs;
  }

  /// Finds where the vector of beams at `at` enters and leaves a slab.
  HWY_INLINE void overlap(int axis, const Slabs& slabs, int i, std::size_t at, VF& enter,
                          VF& leave) const {
    const DF d;
    const auto by_enter = hn::Load(d, enter_[axis] + at), by_leave = hn::Load(d, leave_[axis] + at);
    const auto low = hn::Set(d, slabs.low[i]), high = hn::Set(d, slabs.high[i]);
    switch (ways_[axis]) {
      case Way::kUp:
        enter = hn::Mul(low, by_enter);
        leave = hn::Mul(high, by_leave);
        break;
      case Way::kDown:
        enter = hn::Mul(high, by_enter);
        leave = hn::Mul(low, by_leave);
        break;
      case Way::kEither:
        enter = hn::Max(hn::Mul(high, by_enter), hn::Mul(low, by_leave));
        leave = hn::Set(d, HUGE_VALF);
        break;
    }
  }

  /// Finds which of the visit's beams continue into which children. Sets packet_.first of the beams
  /// that end at a child.
  void intersect(const Visit& visit, ChildBeams& children) {
    const DF d;
    const auto inverse_side = static_cast<double>(std::uint32_t{1} << (visit.level + 1));
    const double side = 1 / inverse_side;
    const Slabs slabs[3] = {slabs_of(0, visit.cell, side), slabs_of(1, visit.cell, side),
                            slabs_of(2, visit.cell, side)};
    const std::uint32_t mask = nodes_.child_mask(visit.node, visit.level);
    std::uint32_t leaves = 0;
    for (int i = 0; i < 8; ++i)
      if ((mask >> i & 1u) != 0 && is_leaf_child(nodes_, visit.node, visit.level, i))
        leaves |= 1u << i;
    // The side of the children, and the factor that gives the t at which a beam is wider than this
    // side.
    const auto child_side = hn::Set(d, static_cast<float>(side) * (1 - kRounding));
    const auto at_start = hn::Set(d, static_cast<float>(packet_.stop.at_start));
    const auto per_enter = hn::Set(d, static_cast<float>(packet_.stop.per_enter));
    const auto per_exit = hn::Set(d, static_cast<float>(packet_.stop.per_exit));
    VF least[8];
    for (VF& enter : least) enter = hn::Set(d, HUGE_VALF);
    for (Beams rest = visit.beams; rest != 0;) {
      const std::size_t at = take_vector(rest);
      VF enters[3][2], leaves_at[3][2];
      for (int axis = 0; axis < 3; ++axis)
        for (int i = 0; i < 2; ++i)
          overlap(axis, slabs[axis], i, at, enters[axis][i], leaves_at[axis][i]);
      auto first = hn::Load(d, packet_.first + at);
      for (std::uint32_t order = 0; order < 8; ++order) {
        const std::uint32_t child = order ^ order_;
        if ((mask >> child & 1u) == 0) continue;
        const std::uint32_t x = child & 1u, y = child >> 1 & 1u, z = child >> 2;
        const auto enter =
            hn::Max(hn::Max(enters[0][x], enters[1][y]), hn::Max(enters[2][z], hn::Zero(d)));
        const auto leave = hn::Min(hn::Min(leaves_at[0][x], leaves_at[1][y]), leaves_at[2][z]);
        const auto is_met = hn::And(hn::Le(enter, leave), hn::Lt(enter, first));
        if ((leaves >> child & 1u) != 0) {
          first = hn::IfThenElse(is_met, enter, first);
          continue;
        }
        const auto limit =
            hn::Max(at_start, hn::Max(hn::Mul(per_enter, enter), hn::Mul(per_exit, leave)));
        const auto ends = hn::Le(child_side, limit);
        first = hn::IfThenElse(hn::And(is_met, ends), enter, first);
        const auto goes_on = hn::AndNot(ends, is_met);
        const Beams beams = bits_of(goes_on) << at & visit.beams;
        if (beams == 0) continue;
        children.beams[order] |= beams;
        least[order] = hn::Min(least[order], hn::IfThenElse(goes_on, enter, least[order]));
      }
      hn::Store(first, d, packet_.first + at);
    }
    for (int order = 0; order < 8; ++order)
      if (children.beams[order] != 0)
        children.enter[order] = hn::GetLane(hn::MinOfLanes(d, least[order]));
  }

  /// Returns the visit's beams that have met nothing before its cell.
  Beams still_searching(const Visit& visit) const {
    const DF d;
    Beams searching = 0;
    for (Beams rest = visit.beams; rest != 0;) {
      const std::size_t at = take_vector(rest);
      searching |= bits_of(hn::Lt(hn::Set(d, visit.enter), hn::Load(d, packet_.first + at))) << at;
    }
    return searching & visit.beams;
  }

  void walk() {
    Visit stack[8 * kMaxLevels];
    std::size_t top = 0;
    stack[top++] = {nodes_.root(), {}, 0, first(packet_.size), 0};
    while (top > 0) {
      Visit visit = stack[--top];
      visit.beams = still_searching(visit);
      if (visit.beams == 0) continue;
      ChildBeams children;
      intersect(visit, children);
      for (std::uint32_t order = 8; order-- > 0;) {
        if (children.beams[order] == 0) continue;
        const auto child = static_cast<int>(order ^ order_);
        stack[top++] = {nodes_.child(visit.node, visit.level, child),
                        visit.cell * 2 + child_offset(child), visit.level + 1,
                        children.beams[order], children.enter[order]};
      }
    }
  }

  const Nodes& nodes_;
  BeamPacket& packet_;
  Way ways_[3];
  std::uint32_t order_ = 0;  ///< The octant that the beams enter first.
  /// The factors of distances along an axis. For Way::kEither both give a t at which beams enter.
  alignas(64) float enter_[3][BeamPacket::kMaxBeams], leave_[3][BeamPacket::kMaxBeams];
};

}  // namespace HWY_NAMESPACE
}  // namespace voxdag
HWY_AFTER_NAMESPACE();

#endif
