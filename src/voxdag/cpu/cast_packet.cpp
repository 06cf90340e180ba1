// Casts up to 64 rays of like direction together. Compiled once for each instruction set; the best
// that the machine has is chosen at run time.
//
// The rays run down the same way along every axis once mirrored, so that all of them meet the
// children of a node in an order that the child index alone gives: one depth-first walk serves all,
// and a node is read once for all rays in it. In a node the nine planes of its children are met at
// nine T for each ray; the range of T in a child is what these leave. A ray is in a child at some T
// as grid_ray.hpp defines it just when that range is not empty, so each ray meets the cells that a
// cast of its own would meet, at the same T, to the bit. In a leaf block it is the other way round:
// the lanes are the voxels, and all 64 are tried for one ray.
//
// The walk starts at the lowest node that holds the starts of all rays, and climbs from there only
// as far as the rays reach.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "voxdag/cpu/cast_packet.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <array>
#include <cmath>

#include "voxdag/cpu/ray_packet.hpp"

HWY_BEFORE_NAMESPACE();
namespace voxdag {
namespace HWY_NAMESPACE {

// The lanes are 8 or 16 rays, or the 8 voxels of an octant: smaller vectors are not worth it.
#if HWY_MAX_BYTES >= 32 && HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128

namespace hn = hwy::HWY_NAMESPACE;

class PacketWalk {
  using DF = hn::CappedTag<float, 16>;
  using VF = hn::Vec<DF>;
  using Rays = std::uint64_t;  ///< Bit i: ray i.
  static constexpr std::size_t kWidth = hn::MaxLanes(DF());
  static constexpr Rays kVectorRays = (Rays{1} << kWidth) - 1;
  /// Rays closer together than this many sides of a cell are taken for one wide one.
  static constexpr float kNarrow = 1.0f;
  static constexpr std::uint32_t kOne = 0x3F800000u;  ///< The bits of 1.0f.

 public:
  PacketWalk(const SvdagNodes& nodes, RayPacket& packet) : nodes_(nodes), packet_(packet) {}

  Rays cast();

 private:
  /// A node to visit.
  struct alignas(32) Visit {
    Rays rays;
    std::uint32_t node;
    std::uint32_t skipped;    ///< Children not to look at, mirrored.
    std::uint32_t corner[3];  ///< Float bits.
    std::uint32_t level;
  };
  /// What a visit is about where rays may end at cells above the voxels.
  struct StopVisit {
    Rays here;   ///< The rays that end at this cell.
    Rays finer;  ///< Those that may end at a cell in this one, if it is a leaf block.
  };
  /// By mirrored child index, the rays that meet the child, and that end there or in it.
  struct ChildRays {
    Rays meet[8], stop[8], finer[8];
  };
  /// The cells, named by the bits that positions in them share.
  struct CommonCell {
    std::uint32_t corner[3];
    int level;  ///< The finest that holds all positions.
  };

  template <class M>
  static HWY_INLINE Rays bits_of(M mask) {
    std::uint8_t bytes[8];
    hn::StoreMaskBits(DF(), mask, bytes);
    if constexpr (kWidth <= 8) return bytes[0];
    return bytes[0] | static_cast<Rays>(bytes[1]) << 8;
  }
  /// Bit i of the result is bit i ^ mirrored of the mask.
  static constexpr std::uint32_t mirrored_mask(std::uint32_t mask, std::uint32_t mirrored) {
    if ((mirrored & 1u) != 0) mask = (mask & 0x55u) << 1 | (mask >> 1 & 0x55u);
    if ((mirrored & 2u) != 0) mask = (mask & 0x33u) << 2 | (mask >> 2 & 0x33u);
    if ((mirrored & 4u) != 0) mask = (mask & 0x0Fu) << 4 | mask >> 4;
    return mask;
  }
  using MaskTable = std::array<std::array<std::uint8_t, 256>, 8>;
  static constexpr MaskTable mirrored_masks() {
    MaskTable table{};
    for (std::uint32_t m = 0; m < 8; ++m)
      for (std::uint32_t mask = 0; mask < 256; ++mask)
        table[m][mask] = static_cast<std::uint8_t>(mirrored_mask(mask, m));
    return table;
  }
  /// The same for both levels of a leaf block.
  static std::uint64_t mirrored_block(std::uint64_t m, std::uint32_t mirrored) {
    const auto swap = [&m](int by, std::uint64_t low) { m = (m & low) << by | (m >> by & low); };
    if ((mirrored & 1u) != 0) {
      swap(1, 0x5555555555555555u);
      swap(8, 0x00FF00FF00FF00FFu);
    }
    if ((mirrored & 2u) != 0) {
      swap(2, 0x3333333333333333u);
      swap(16, 0x0000FFFF0000FFFFu);
    }
    if ((mirrored & 4u) != 0) {
      swap(4, 0x0F0F0F0F0F0F0F0Fu);
      m = m << 32 | m >> 32;
    }
    return m;
  }

  void pad();
  void bound();
  std::uint32_t children_met_by_hull(const std::uint32_t corner[3], int level) const;
  bool is_narrow(const std::uint32_t corner[3], int level) const;
  void common_cells(CommonCell& starts, CommonCell& reach, int finest) const;
  int finest_without_stop() const;
  std::size_t begin(Rays all, Visit* stack) const;
  template <bool kWithStop>
  Rays walk(Rays all);
  static HWY_INLINE void set_child(Visit& visit, const Visit& parent, std::uint32_t child,
                                   std::uint32_t half) {
    // By the child's bits: whether half is added to the corner.
    alignas(16) static constexpr std::uint32_t kBits[8][4] = {
        {0, 0, 0, 0},   {~0u, 0, 0, 0},   {0, ~0u, 0, 0},   {~0u, ~0u, 0, 0},
        {0, 0, ~0u, 0}, {~0u, 0, ~0u, 0}, {0, ~0u, ~0u, 0}, {~0u, ~0u, ~0u, 0}};
    const hn::CappedTag<std::uint32_t, 4> d;
    alignas(16) static constexpr std::uint32_t kNextLevel[4] = {0, 0, 0, 1};
    const auto corner = hn::Add(hn::LoadU(d, parent.corner), hn::Load(d, kNextLevel));
    hn::StoreU(hn::Or(corner, hn::And(hn::Load(d, kBits[child]), hn::Set(d, half))), d,
               visit.corner);
  }
  template <bool kWithStop>
  void intersect(const std::uint32_t corner[3], int level, Rays rays, ChildRays& children) const;
  Rays cast_in_block(std::uint64_t block, const std::uint32_t corner[3], int levels, Rays rays);
  void record(Rays rays, const std::uint32_t corner[3], int level) {
    for (; rays != 0; rays &= rays - 1) {
      const int i = lowest_bit64(rays);
      for (int axis = 0; axis < 3; ++axis) packet_.cell[i][axis] = corner[axis];
      packet_.level[i] = level;
    }
  }

  const SvdagNodes& nodes_;
  RayPacket& packet_;
  /// Least and greatest of all rays, by axis, then of t_min and t_end.
  float origin_range_[3][2], inverse_range_[3][2], t_range_[2];
  int stop_level_;  ///< Rays that may end above the voxels do so at this level or finer ones.
  float last_t_min_, stop_range_[2];    ///< The greatest; of stop_start and stop_per_t.
  float width_at_start_, width_per_t_;  ///< About how far apart the rays are at T.
};

/// Fills the last vector with copies of the last ray.
inline void PacketWalk::pad() {
  for (std::size_t i = packet_.size; i % kWidth != 0; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      packet_.origin[axis][i] = packet_.origin[axis][packet_.size - 1];
      packet_.inverse[axis][i] = packet_.inverse[axis][packet_.size - 1];
    }
    packet_.t_min[i] = packet_.t_min[packet_.size - 1];
    packet_.t_end[i] = packet_.t_end[packet_.size - 1];
    packet_.stop_start[i] = packet_.stop_per_t[i] = 0;
  }
}

/// Finds the ranges that the rays are in.
inline void PacketWalk::bound() {
  const DF d;
  const auto range = [&](const float* values, float out[2]) HWY_ATTR {
    auto low = hn::Load(d, values), high = low;
    for (std::size_t i = kWidth; i < packet_.size; i += kWidth) {
      low = hn::Min(low, hn::Load(d, values + i));
      high = hn::Max(high, hn::Load(d, values + i));
    }
    out[0] = hn::GetLane(hn::MinOfLanes(d, low));
    out[1] = hn::GetLane(hn::MaxOfLanes(d, high));
  };
  width_at_start_ = width_per_t_ = 0;
  for (int axis = 0; axis < 3; ++axis) {
    range(packet_.origin[axis], origin_range_[axis]);
    range(packet_.inverse[axis], inverse_range_[axis]);
    const float apart = origin_range_[axis][1] - origin_range_[axis][0];
    const float spread = 1 / inverse_range_[axis][0] - 1 / inverse_range_[axis][1];
    width_at_start_ = apart > width_at_start_ ? apart : width_at_start_;
    width_per_t_ = spread > width_per_t_ ? spread : width_per_t_;
  }
  float least[2], most[2];
  range(packet_.t_min, least);
  range(packet_.t_end, most);
  t_range_[0] = least[0];
  t_range_[1] = most[1];
  last_t_min_ = least[1];
  if (!packet_.has_stop) return;
  range(packet_.stop_start, least);
  range(packet_.stop_per_t, most);
  stop_range_[0] = least[1];
  stop_range_[1] = most[1];
  // T is at most 1 in the grid.
  const float limit = (stop_range_[0] + stop_range_[1]) * (1 + 0x1p-10f);
  for (stop_level_ = packet_.coarsest; stop_level_ < nodes_.levels(); ++stop_level_)
    if (float_from_bits(static_cast<std::uint32_t>(127 - stop_level_) << 23) <= limit) break;
}

/// Whether the rays are close together for the children of this node: not worth telling apart.
inline bool PacketWalk::is_narrow(const std::uint32_t corner[3], int level) const {
  const std::uint32_t size = 1u << (23 - level);
  float enter = t_range_[0];
  for (int axis = 0; axis < 3; ++axis) {
    const float t =
        (origin_range_[axis][0] - float_from_bits(corner[axis] + size)) * inverse_range_[axis][0];
    enter = t > enter ? t : enter;
  }
  const float side = float_from_bits(static_cast<std::uint32_t>(126 - level) << 23);
  return width_at_start_ + width_per_t_ * enter < kNarrow * side;
}

/// The children of the node of `level` at `corner` that any ray can meet. The bounds of T hold in
/// float arithmetic too, since rounding is monotone.
inline std::uint32_t PacketWalk::children_met_by_hull(const std::uint32_t corner[3],
                                                      int level) const {
  const hn::CappedTag<float, 8> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  static_assert(hn::MaxLanes(d) == 8);
  alignas(32) static constexpr std::uint32_t kUpper[3][8] = {{0, ~0u, 0, ~0u, 0, ~0u, 0, ~0u},
                                                             {0, 0, ~0u, ~0u, 0, 0, ~0u, ~0u},
                                                             {0, 0, 0, 0, ~0u, ~0u, ~0u, ~0u}};
  const auto half = hn::Set(du, 1u << (22 - level));
  auto enter = hn::Set(d, t_range_[0]), exit = hn::Set(d, t_range_[1]);
  for (int axis = 0; axis < 3; ++axis) {
    const auto low = hn::Or(hn::Set(du, corner[axis]), hn::And(hn::Load(du, kUpper[axis]), half));
    const auto high = hn::Add(low, half);
    const auto slow = hn::Set(d, inverse_range_[axis][1]),
               fast = hn::Set(d, inverse_range_[axis][0]);
    const auto to_high = hn::Sub(hn::Set(d, origin_range_[axis][0]), hn::BitCast(d, high));
    const auto to_low = hn::Sub(hn::Set(d, origin_range_[axis][1]), hn::BitCast(d, low));
    enter = hn::Max(enter, hn::Mul(to_high, hn::IfNegativeThenElse(to_high, slow, fast)));
    exit = hn::Min(exit, hn::Mul(to_low, hn::IfNegativeThenElse(to_low, fast, slow)));
  }
  std::uint8_t bits[8];
  hn::StoreMaskBits(d, hn::Lt(enter, exit), bits);
  return bits[0];
}

/// The lowest cells, of level `finest` at most, that hold the starts of all rays, and starts and
/// ends. A position p here is in the cell with lower < p <= upper, as the voxel rule has it.
inline void PacketWalk::common_cells(CommonCell& starts, CommonCell& reach, int finest) const {
  const DF d;
  const hn::RebindToUnsigned<DF> du;
  // More than the rounding of T, of the quotient and of the difference here.
  const auto slack = hn::Set(d, 0x1p-21f);
  const auto zero = hn::Zero(d), least = hn::Set(d, 1 + 0x1p-23f), two = hn::Set(d, 2);
  std::uint32_t start_differs = 0, reach_differs = 0;
  for (int axis = 0; axis < 3; ++axis) {
    auto start_or = hn::Zero(du), start_and = hn::Set(du, ~0u);
    auto end_or = start_or, end_and = start_and;
    for (std::size_t i = 0; i < packet_.size; i += kWidth) {
      const auto origin = hn::Load(d, packet_.origin[axis] + i),
                 inverse = hn::Load(d, packet_.inverse[axis] + i);
      const auto t_min = hn::Load(d, packet_.t_min + i);
      const auto is_later = hn::Gt(t_min, zero);
      const auto start = hn::Sub(origin, hn::Div(t_min, inverse));
      const auto start_slack = hn::IfThenElseZero(is_later, slack);
      const auto end = hn::Sub(origin, hn::Div(hn::Load(d, packet_.t_end + i), inverse));
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

/// The finest level above the blocks down to which no ray may end at the cell where it starts: it
/// leaves a cell of this side no later than at t_min + side, as T grows by 1 across the grid.
inline int PacketWalk::finest_without_stop() const {
  int level = 0;
  for (; level < nodes_.levels() - 2; ++level) {
    if (level + 1 < stop_level_) continue;
    const float side = float_from_bits(static_cast<std::uint32_t>(126 - level) << 23);
    const float leaves = last_t_min_ + side;
    if (side <= (stop_range_[0] + stop_range_[1] * leaves) * (1 + 0x1p-10f)) break;
  }
  return level;
}

/// Puts the nodes to visit first on the stack; returns how many.
inline std::size_t PacketWalk::begin(Rays all, Visit* stack) const {
  CommonCell starts, reach;
  common_cells(starts, reach, packet_.has_stop ? finest_without_stop() : nodes_.levels() - 2);
  std::size_t top = 0;
  std::uint32_t node = nodes_.root();
  for (int level = 0;; ++level) {
    const std::uint32_t child_bit = 22u - static_cast<std::uint32_t>(level);
    const std::uint32_t index = (starts.corner[0] >> child_bit & 1u) |
                                (starts.corner[1] >> child_bit & 1u) << 1 |
                                (starts.corner[2] >> child_bit & 1u) << 2;
    const std::uint32_t unmirrored = nodes_.child_mask(node, level);
    const bool descends =
        level < starts.level && (unmirrored >> (index ^ packet_.mirrored) & 1u) != 0;
    if (level >= reach.level || !descends) {
      // Of the rays' own child's cell nothing is left above the node where they start.
      Visit& visit = stack[top++];
      visit.rays = all;
      visit.node = node;
      for (int axis = 0; axis < 3; ++axis)
        visit.corner[axis] = level == 0 ? kOne : starts.corner[axis] & ~0u << (child_bit + 1);
      visit.level = static_cast<std::uint32_t>(level);
      visit.skipped = descends ? 1u << index : 0u;
    }
    if (!descends) return top;
    node = nodes_.child(node, level, static_cast<int>(index ^ packet_.mirrored));
  }
}

/// Which of `rays` meet which children of the node of `level` at `corner`.
template <bool kWithStop>
HWY_INLINE void PacketWalk::intersect(const std::uint32_t corner[3], int level, Rays rays,
                                      ChildRays& children) const {
  const DF d;
  const std::uint32_t half = 1u << (22 - level);
  const auto plane = [&](int axis, std::uint32_t i)
                         HWY_ATTR { return hn::Set(d, float_from_bits(corner[axis] + i * half)); };
  const auto x0 = plane(0, 0), x1 = plane(0, 1), x2 = plane(0, 2);
  const auto y0 = plane(1, 0), y1 = plane(1, 1), y2 = plane(1, 2);
  const auto z0 = plane(2, 0), z1 = plane(2, 1), z2 = plane(2, 2);
  const auto side = hn::Set(d, float_from_bits(static_cast<std::uint32_t>(126 - level) << 23));
  const auto half_side = hn::Mul(side, hn::Set(d, 0.5f));
  Rays m0 = 0, m1 = 0, m2 = 0, m3 = 0, m4 = 0, m5 = 0, m6 = 0, m7 = 0;
  if constexpr (kWithStop)
    for (int i = 0; i < 8; ++i) children.stop[i] = children.finer[i] = 0;

  for (Rays rest = rays; rest != 0;) {
    const std::size_t first = static_cast<std::size_t>(lowest_bit64(rest)) & ~(kWidth - 1);
    rest &= ~(kVectorRays << first);
    const auto t = [&](int axis, VF position) HWY_ATTR {
      return hn::Mul(hn::Sub(hn::Load(d, packet_.origin[axis] + first), position),
                     hn::Load(d, packet_.inverse[axis] + first));
    };
    const auto tx0 = t(0, x0), tx1 = t(0, x1), tx2 = t(0, x2);
    const auto ty0 = t(1, y0), ty1 = t(1, y1), ty2 = t(1, y2);
    const auto tz0 = t(2, z0), tz1 = t(2, z1), tz2 = t(2, z2);
    const auto t_min = hn::Load(d, packet_.t_min + first),
               t_end = hn::Load(d, packet_.t_end + first);
    const auto enter_z0 = hn::Max(tz1, t_min), enter_z1 = hn::Max(tz2, t_min);
    const auto exit_z0 = hn::Min(tz0, t_end), exit_z1 = hn::Min(tz1, t_end);
    // A pair of children, one above the other.
    const auto column = [&](std::size_t child, VF enter_xy, VF exit_xy, Rays& lower,
                            Rays& upper) HWY_ATTR {
      lower |= bits_of(hn::Lt(hn::Max(enter_xy, enter_z0), hn::Min(exit_xy, exit_z0))) << first;
      upper |= bits_of(hn::Lt(hn::Max(enter_xy, enter_z1), hn::Min(exit_xy, exit_z1))) << first;
      if constexpr (kWithStop) {
        const auto judge = [&](std::size_t i, VF exit_z) HWY_ATTR {
          const auto limit =
              hn::Add(hn::Load(d, packet_.stop_start + first),
                      hn::Mul(hn::Load(d, packet_.stop_per_t + first), hn::Min(exit_xy, exit_z)));
          children.stop[i] |= bits_of(hn::Le(side, limit)) << first;
          children.finer[i] |= bits_of(hn::Le(half_side, limit)) << first;
        };
        judge(child, tz0);
        judge(child + 4, tz1);
      }
    };
    column(0, hn::Max(tx1, ty1), hn::Min(tx0, ty0), m0, m4);
    column(1, hn::Max(tx2, ty1), hn::Min(tx1, ty0), m1, m5);
    column(2, hn::Max(tx1, ty2), hn::Min(tx0, ty1), m2, m6);
    column(3, hn::Max(tx2, ty2), hn::Min(tx1, ty1), m3, m7);
  }
  children.meet[0] = m0 & rays;
  children.meet[1] = m1 & rays;
  children.meet[2] = m2 & rays;
  children.meet[3] = m3 & rays;
  children.meet[4] = m4 & rays;
  children.meet[5] = m5 & rays;
  children.meet[6] = m6 & rays;
  children.meet[7] = m7 & rays;
}

/// Casts rays, one by one, at the 4³ voxels of the block at `corner`; lane i of a vector is voxel i
/// of an octant. Sets the cells of those that meet one and returns them.
inline PacketWalk::Rays PacketWalk::cast_in_block(std::uint64_t block,
                                                  const std::uint32_t corner[3], int levels,
                                                  Rays rays) {
  const hn::CappedTag<float, 8> d;
  constexpr std::size_t kBlockLanes = hn::MaxLanes(d);
  static_assert(kBlockLanes == 8);
  using V = hn::Vec<decltype(d)>;
  alignas(32) static constexpr std::uint32_t kOffset[3][8] = {
      {0, 1, 0, 1, 0, 1, 0, 1}, {0, 0, 1, 1, 0, 0, 1, 1}, {0, 0, 0, 0, 1, 1, 1, 1}};
  const hn::RebindToUnsigned<decltype(d)> du;
  const std::uint32_t size = 1u << (23 - levels);
  V lower[3][2], upper[3][2];
  for (int axis = 0; axis < 3; ++axis)
    for (std::uint32_t octant = 0; octant < 2; ++octant) {
      const auto offset = hn::Add(hn::Load(du, kOffset[axis]), hn::Set(du, 2 * octant));
      const auto low = hn::Add(hn::Set(du, corner[axis]), hn::Mul(offset, hn::Set(du, size)));
      lower[axis][octant] = hn::BitCast(d, low);
      upper[axis][octant] = hn::BitCast(d, hn::Add(low, hn::Set(du, size)));
    }

  Rays hits = 0;
  for (Rays rest = rays; rest != 0; rest &= rest - 1) {
    const int i = lowest_bit64(rest);
    V enter[3][2], exit[3][2];
    for (int axis = 0; axis < 3; ++axis) {
      const auto origin = hn::Set(d, packet_.origin[axis][i]),
                 inverse = hn::Set(d, packet_.inverse[axis][i]);
      for (int octant = 0; octant < 2; ++octant) {
        enter[axis][octant] = hn::Mul(hn::Sub(origin, upper[axis][octant]), inverse);
        exit[axis][octant] = hn::Mul(hn::Sub(origin, lower[axis][octant]), inverse);
      }
    }
    const auto t_min = hn::Set(d, packet_.t_min[i]), t_end = hn::Set(d, packet_.t_end[i]);
    for (int octant = 0; octant < 2; ++octant) {
      enter[2][octant] = hn::Max(enter[2][octant], t_min);
      exit[2][octant] = hn::Min(exit[2][octant], t_end);
    }
    std::uint64_t met = 0;
    for (int xy = 0; xy < 4; ++xy) {
      const auto enter_xy = hn::Max(enter[0][xy & 1], enter[1][xy >> 1]);
      const auto exit_xy = hn::Min(exit[0][xy & 1], exit[1][xy >> 1]);
      for (int z = 0; z < 2; ++z) {
        std::uint8_t bits[8];
        hn::StoreMaskBits(d, hn::Lt(hn::Max(enter_xy, enter[2][z]), hn::Min(exit_xy, exit[2][z])),
                          bits);
        met |= static_cast<std::uint64_t>(bits[0]) << (8 * (xy + 4 * z));
      }
    }
    met &= block;
    if (met == 0) continue;
    hits |= Rays{1} << i;
    const auto first = static_cast<std::uint32_t>(63 - __builtin_clzll(met));
    for (std::uint32_t axis = 0; axis < 3; ++axis)
      packet_.cell[i][axis] =
          corner[axis] + ((first >> axis & 1u) | (first >> (2 + axis) & 2u)) * size;
    packet_.level[i] = levels;
  }
  return hits;
}

template <bool kWithStop>
inline PacketWalk::Rays PacketWalk::walk(Rays all) {
  static constexpr MaskTable kMasks = mirrored_masks();
  const std::array<std::uint8_t, 256>& masks = kMasks[packet_.mirrored];
  const std::uint32_t mirrored = packet_.mirrored;
  const auto levels = static_cast<std::uint32_t>(nodes_.levels());
  Rays searching = all;
  Visit stack[8 * kMaxLevels];
  StopVisit stop_stack[kWithStop ? 8 * kMaxLevels : 1];
  std::size_t top = begin(all, stack);
  if constexpr (kWithStop)
    for (std::size_t i = 0; i < top; ++i) stop_stack[i] = {0, all};

  while (top > 0) {
    // Field by field, as it was stored: a wider load would wait for the stores. The corner and the
    // level were stored as one.
    const Visit& popped = stack[--top];
    Rays rays = popped.rays & searching;
    Visit visit;
    visit.node = popped.node;
    visit.skipped = popped.skipped;
    const hn::CappedTag<std::uint32_t, 4> d4;
    hn::StoreU(hn::LoadU(d4, popped.corner), d4, visit.corner);
    bool is_block = visit.level + 2 == levels;
    if constexpr (kWithStop) {
      const StopVisit stop = stop_stack[top];
      if (const Rays ended = stop.here & rays; ended != 0) {
        record(ended, visit.corner, static_cast<int>(visit.level));
        searching &= ~ended;
        rays &= ~ended;
      }
      is_block = is_block && (stop.finer & rays) == 0;
    }
    if (rays == 0) continue;
    if (is_block) {
      const std::uint64_t block = mirrored_block(nodes_.block(visit.node), mirrored);
      searching &= ~cast_in_block(block, visit.corner, static_cast<int>(levels), rays);
      if (searching == 0) break;
      continue;
    }

    const int level = static_cast<int>(visit.level);
    const std::uint32_t mask = masks[nodes_.child_mask(visit.node, level)] & ~visit.skipped;
    ChildRays children;
    std::uint32_t met;
    const std::uint32_t child_level = visit.level + 1;
    const bool with_stop =
        kWithStop && child_level >= static_cast<std::uint32_t>(stop_level_) && child_level < levels;
    if (!with_stop && (rays >> (2 * kWidth - 1) >> 1) != 0 && child_level < levels &&
        is_narrow(visit.corner, level)) {
      met = children_met_by_hull(visit.corner, level) & mask;
      for (Rays& meet : children.meet) meet = rays;
    } else {
      if (with_stop)
        intersect<true>(visit.corner, level, rays, children);
      else
        intersect<false>(visit.corner, level, rays, children);
      met = mask;
    }

    const std::uint32_t half = 1u << (22 - visit.level);
    if (kWithStop && child_level == levels) {
      while (met != 0) {
        const auto child = static_cast<std::uint32_t>(highest_bit(met));
        met ^= 1u << child;
        Visit voxel;
        set_child(voxel, visit, child, half);
        const Rays hits = children.meet[child] & searching;
        record(hits, voxel.corner, static_cast<int>(levels));
        searching &= ~hits;
      }
      if (searching == 0) break;
      continue;
    }
    for (; met != 0; met &= met - 1) {
      const auto child = static_cast<std::uint32_t>(__builtin_ctz(met));
      Visit& next = stack[top];
      next.rays = children.meet[child];
      next.node = nodes_.child(visit.node, level, static_cast<int>(child ^ mirrored));
      next.skipped = 0;
      hwy::Prefetch(static_cast<const std::uint32_t*>(nodes_.address(next.node, level + 1)));
      set_child(next, visit, child, half);
      if constexpr (kWithStop) {
        // Cells too coarse to be judged are not the last above voxels.
        stop_stack[top].here = with_stop ? children.stop[child] : 0;
        stop_stack[top].finer = with_stop ? children.finer[child] : next.rays;
      }
      top += next.rays != 0 ? 1 : 0;
    }
  }
  return all & ~searching;
}

inline PacketWalk::Rays PacketWalk::cast() {
  if (packet_.size == 0 || nodes_.is_empty()) return 0;
  pad();
  bound();
  const Rays all = packet_.size == RayPacket::kMaxRays ? ~Rays{0} : (Rays{1} << packet_.size) - 1;
  return packet_.has_stop && stop_level_ < nodes_.levels() ? walk<true>(all) : walk<false>(all);
}

std::uint64_t cast_packet_simd(const SvdagNodes& nodes, RayPacket& packet) {
  return PacketWalk(nodes, packet).cast();
}

#else

std::uint64_t cast_packet_simd(const SvdagNodes& nodes, RayPacket& packet) {
  std::uint64_t hits = 0;
  for (std::size_t i = 0; i < packet.size; ++i) {
    GridRay ray;
    for (int axis = 0; axis < 3; ++axis) {
      ray.origin[axis] = packet.origin[axis][i];
      ray.inverse[axis] = packet.inverse[axis][i];
    }
    ray.t_min = packet.t_min[i];
    ray.t_max = packet.t_end[i] < HUGE_VALF ? float_from_bits(bits_of_float(packet.t_end[i]) - 1)
                                            : packet.t_end[i];
    ray.mirrored = packet.mirrored;
    const StopBelowSize stop{packet.stop_start[i], packet.stop_per_t[i], packet.coarsest};
    CellHit hit;
    if (!voxdag::cast(nodes, ray, stop, hit)) continue;
    hits |= std::uint64_t{1} << i;
    packet.cell[i][0] = hit.x;
    packet.cell[i][1] = hit.y;
    packet.cell[i][2] = hit.z;
    packet.level[i] = hit.level;
  }
  return hits;
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace voxdag
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace voxdag {

HWY_EXPORT(cast_packet_simd);

std::uint64_t cast_packet(const SvdagNodes& nodes, RayPacket& packet) {
  return HWY_DYNAMIC_DISPATCH(cast_packet_simd)(nodes, packet);
}

}  // namespace voxdag
#endif
