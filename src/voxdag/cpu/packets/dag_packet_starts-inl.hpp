// Finds the cells at which the walk of a packet may begin: the finest cells that hold all its rays.
#if defined(VOXDAG_DAG_PACKET_STARTS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXDAG_DAG_PACKET_STARTS_INL
#undef VOXDAG_DAG_PACKET_STARTS_INL
#else
#define VOXDAG_DAG_PACKET_STARTS_INL
#endif

#include "voxdag/cpu/packets/dag_packet_walk-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace voxdag {
namespace HWY_NAMESPACE {

#if VOXDAG_PACKET_LANES

/// Finds two cells: the finest cell, of level `finest` at most, that holds the starts of all rays
/// (`starts`), and the finest cell that holds all starts and ends (`reach`). By the voxel rule, a
/// position p is in the cell with lower < p <= upper.
inline void DagPacketWalk::common_cells(CommonCell& starts, CommonCell& reach, int finest) const {
  const DF d;
  const hn::RebindToUnsigned<DF> du;
  // Larger than the rounding errors of T and of this calculation.
  const auto slack = hn::Set(d, 0x1p-21f);
  const auto zero = hn::Zero(d), least = hn::Set(d, 1 + 0x1p-23f), two = hn::Set(d, 2);
  std::uint32_t start_differs = 0, reach_differs = 0;
  for (int axis = 0; axis < 3; ++axis) {
    auto start_or = hn::Zero(du), start_and = hn::Set(du, ~0u);
    auto end_or = start_or, end_and = start_and;
    for (std::size_t i = 0; i < rays_.size; i += kWidth) {
      const auto origin = hn::Load(d, rays_.origin[axis] + i),
                 per_t = hn::Div(hn::Set(d, 1), hn::Load(d, rays_.inverse[axis] + i));
      const auto t_min = hn::Load(d, rays_.t_min + i);
      const auto is_later = hn::Gt(t_min, zero);
      const auto start = hn::Sub(origin, hn::Mul(t_min, per_t));
      const auto start_slack = hn::IfThenElseZero(is_later, slack);
      const auto end = hn::Sub(origin, hn::Mul(hn::Load(d, rays_.t_end + i), per_t));
      const auto bits = [&](VF p) HWY_ATTR {
        const auto inside = hn::Min(hn::Max(p, least), two);
        return hn::Sub(hn::BitCast(du, inside), hn::Set(du, 1));
      };
      const auto low = bits(hn::Sub(start, start_slack)), high = bits(hn::Add(start, start_slack));
      const auto last = bits(hn::Sub(end, slack));
      start_or = hn::Or(start_or, hn::Or(low, high));
      start_and = hn::And(start_and, hn::And(low, high));
      end_or = hn::Or(end_or, last);
      end_and = hn::And(end_and, last);
    }
    alignas(64) std::uint32_t lanes[4][kWidth];
    hn::Store(start_or, du, lanes[0]);
    hn::Store(start_and, du, lanes[1]);
    hn::Store(end_or, du, lanes[2]);
    hn::Store(end_and, du, lanes[3]);
    std::uint32_t any = 0, every = ~0u, any_end = 0, every_end = ~0u;
    for (std::size_t i = 0; i < kWidth; ++i) {
      any |= lanes[0][i];
      every &= lanes[1][i];
      any_end |= lanes[2][i];
      every_end &= lanes[3][i];
    }
    start_differs |= any ^ every;
    reach_differs |= (any | any_end) ^ (every & every_end);
    starts.corner[axis] = reach.corner[axis] = every;
  }
  const auto finish = [&](CommonCell& cell, std::uint32_t differs) {
    cell.level = differs == 0 ? finest : 22 - highest_bit(differs);
    cell.level = cell.level > finest ? finest : cell.level < 0 ? 0 : cell.level;
  };
  finish(starts, start_differs);
  finish(reach, reach_differs);
}

/// Returns the finest level above the leaf blocks at which no ray may end in its first cell. A ray
/// leaves that cell at t_min + side at the latest, because T grows by 1 across the grid.
inline int DagPacketWalk::finest_without_stop() const {
  int level = 0;
  for (; level < levels_ - 2; ++level) {
    if (level + 1 < stop_level_) continue;
    const float side = side_of(level + 1);
    const float leaves = last_t_min_ + side;
    if (side <= (stop_start_[1] + stop_per_t_[1] * leaves) * (1 + 0x1p-10f)) break;
  }
  return level;
}

#endif  // VOXDAG_PACKET_LANES

}  // namespace HWY_NAMESPACE
}  // namespace voxdag
HWY_AFTER_NAMESPACE();

#endif
