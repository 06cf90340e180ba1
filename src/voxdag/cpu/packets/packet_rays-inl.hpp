// The rays of a packet in lanes, and what is known of all of them: what the walks at DAGs and ESVOs
// share.
#if defined(VOXDAG_PACKET_RAYS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXDAG_PACKET_RAYS_INL
#undef VOXDAG_PACKET_RAYS_INL
#else
#define VOXDAG_PACKET_RAYS_INL
#endif

#include <array>
#include <cmath>

#include "voxdag/cpu/packets/packet_lanes-inl.hpp"
#include "voxdag/cpu/packets/ray_packet.hpp"

HWY_BEFORE_NAMESPACE();
namespace voxdag {
namespace HWY_NAMESPACE {

#if VOXDAG_PACKET_LANES

/// Whether all rays start at one point, mirrored.
inline bool have_one_origin(const RayPacket& packet) {
  static_assert(offsetof(GridRay, origin) == 0 && sizeof(GridRay) >= 16);
  const hn::CappedTag<float, 4> d;
  const auto origin = [&](std::size_t i) HWY_ATTR {
    return hn::LoadU(d, reinterpret_cast<const float*>(packet.rays[i]));
  };
  const auto first = origin(0);
  std::uint8_t bits[8] = {};
  for (std::size_t i = 1; i < packet.size; ++i) {
    hn::StoreMaskBits(d, hn::Ne(origin(i), first), bits);
    if ((bits[0] & 7u) != 0) return false;
  }
  return true;
}

class PacketRays : protected PacketLanes {
 protected:
  using Rays = Set;
  using DF8 = hn::CappedTag<float, 8>;  ///< Lanes are the children of a node.
  using DU8 = hn::RebindToUnsigned<DF8>;
  static_assert(hn::MaxLanes(DF8()) == 8);
  /// Rays closer together than this many sides of a cell are taken for one wide one.
  static constexpr float kNarrow = 1.0f;
  /// So many rays at most are looked at one after the other, against all children at once.
  static constexpr int kFew = 6;
  static constexpr std::uint32_t kOne = 0x3F800000u;  ///< The bits of 1.0f.

  using D4 = hn::CappedTag<std::uint32_t, 4>;
  /// A cell, whose words are read and written as one vector.
  struct alignas(16) Cell {
    std::uint32_t corner[3];  ///< Float bits.
    std::uint32_t level;
  };
  static_assert(sizeof(Cell) == 16);
  /// The least and the greatest of all rays by axis; then 0, so that a fourth lane stays 0.
  struct alignas(16) Ranges {
    float least[4], most[4];
  };

  /// The rays, by axis, then by ray; the last vector is filled up with copies of the last ray.
  struct Lanes {
    alignas(64) float origin[3][RayPacket::kMaxRays], inverse[3][RayPacket::kMaxRays];
    alignas(64) float t_min[RayPacket::kMaxRays];
    /// The next float after t_max: a cell is met if it is entered before that.
    alignas(64) float t_end[RayPacket::kMaxRays];
    alignas(64) float stop_start[RayPacket::kMaxRays], stop_per_t[RayPacket::kMaxRays];
    std::size_t size;
    std::uint32_t mirrored;
    int coarsest;  ///< Of the levels of detail.
    bool has_stop;
  };

  /// Of one ray at least.
  void load(const RayPacket& packet);
  /// Finds the ranges that the rays are in. `levels` is L, or more.
  void bound(int levels);
  /// Whether the rays are close together for the children of this cell: not worth telling apart.
  /// None enters it before `enter`.
  bool are_narrow(const Cell& cell, float enter) const;
  /// No ray that meets the cell leaves it later.
  float last_exit(const Cell& cell) const;
  /// Whether any is beyond the first two vectors: those that are not are told apart as fast.
  static bool are_many(Rays rays) { return (rays >> (2 * kWidth - 1) >> 1) != 0; }

  /// Moves the bounds on where the rays enter and leave boxes, one a lane, to between the boxes'
  /// sides across an axis. They hold in float arithmetic too, since rounding is monotone.
  HWY_INLINE void bound_by_sides(int axis, hn::Vec<DF8> low, hn::Vec<DF8> high, hn::Vec<DF8>& enter,
                                 hn::Vec<DF8>& exit) const {
    const DF8 d;
    bound_by_distances(axis, hn::Sub(hn::Set(d, origins_.least[axis]), high),
                       hn::Sub(hn::Set(d, origins_.most[axis]), low), enter, exit);
  }
  /// The same of the least distances down to the upper sides, and the greatest to the lower ones.
  HWY_INLINE void bound_by_distances(int axis, hn::Vec<DF8> to_high, hn::Vec<DF8> to_low,
                                     hn::Vec<DF8>& enter, hn::Vec<DF8>& exit) const {
    const DF8 d;
    const auto slow = hn::Set(d, inverses_.most[axis]), fast = hn::Set(d, inverses_.least[axis]);
    enter = hn::Max(enter, hn::Mul(to_high, hn::IfNegativeThenElse(to_high, slow, fast)));
    exit = hn::Min(exit, hn::Mul(to_low, hn::IfNegativeThenElse(to_low, fast, slow)));
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
  std::uint32_t mirrored(std::uint32_t mask) const { return mirrored_masks_[mask]; }
  static HWY_INLINE std::uint32_t bits_of_children(hn::Mask<DF8> mask) {
    std::uint8_t bits[8];
    hn::StoreMaskBits(DF8(), mask, bits);
    return bits[0];
  }
  template <class Level>
  static HWY_INLINE float side_of(Level level) {
    return float_from_bits((127u - static_cast<std::uint32_t>(level)) << 23);
  }
  /// All bits of the first three words.
  alignas(16) static constexpr std::uint32_t kAxes[4] = {~0u, ~0u, ~0u, 0};
  /// By axis: all bits of the children in the upper half.
  alignas(32) static constexpr std::uint32_t kUpper[3][8] = {{0, ~0u, 0, ~0u, 0, ~0u, 0, ~0u},
                                                             {0, 0, ~0u, ~0u, 0, 0, ~0u, ~0u},
                                                             {0, 0, 0, 0, ~0u, ~0u, ~0u, ~0u}};
  static HWY_INLINE hn::Vec<D4> load(const Cell& cell) {
    return hn::LoadU(D4(), reinterpret_cast<const std::uint32_t*>(&cell));
  }
  static HWY_INLINE void store(hn::Vec<D4> words, Cell& cell) {
    hn::StoreU(words, D4(), reinterpret_cast<std::uint32_t*>(&cell));
  }
  static HWY_INLINE void set_child(const Cell& parent, std::uint32_t child, Cell& cell) {
    // By the child's bits: whether its side is added to the corner.
    alignas(16) static constexpr std::uint32_t kBits[8][4] = {
        {0, 0, 0, 0},   {~0u, 0, 0, 0},   {0, ~0u, 0, 0},   {~0u, ~0u, 0, 0},
        {0, 0, ~0u, 0}, {~0u, 0, ~0u, 0}, {0, ~0u, ~0u, 0}, {~0u, ~0u, ~0u, 0}};
    alignas(16) static constexpr std::uint32_t kNextLevel[4] = {0, 0, 0, 1};
    const D4 d;
    const auto side = hn::Set(d, 1u << (22 - parent.level));
    const auto first = hn::Add(load(parent), hn::Load(d, kNextLevel));
    store(hn::Or(first, hn::And(hn::Load(d, kBits[child]), side)), cell);
  }

  Lanes rays_;
  const std::uint8_t* mirrored_masks_;  ///< By mask.
  Ranges origins_, inverses_;
  /// Least and greatest of all rays, of t_min and t_end.
  float t_range_[2];
  float stop_start_[2], stop_per_t_[2];
  float last_t_min_;
  int stop_level_;  ///< No ray ends above this level but at voxels; `levels` where none does.
  float width_at_start_, width_per_t_;  ///< About how far apart the rays are at T.
};

/// Transposes eight rays at a time: the first eight floats of each, then its level of detail.
inline void PacketRays::load(const RayPacket& packet) {
  static_assert(offsetof(GridRay, origin) == 0 && offsetof(GridRay, inverse) == 12 &&
                offsetof(GridRay, t_min) == 24 && offsetof(GridRay, t_max) == 28);
  static_assert(offsetof(CastRay, ray) == 0 && offsetof(StopBelowSize, at_start) == 0 &&
                offsetof(StopBelowSize, per_t) == 4 &&
                offsetof(CastRay, stop) + 16 <= sizeof(CastRay));
  const hn::CappedTag<float, 8> d;
  const hn::Half<decltype(d)> half;
  const hn::RepartitionToWide<decltype(d)> wide;
  using V = hn::Vec<decltype(d)>;
  const auto lower = [&](V a, V b)
                         HWY_ATTR { return hn::BitCast(wide, hn::InterleaveLower(d, a, b)); };
  const auto upper = [&](V a, V b)
                         HWY_ATTR { return hn::BitCast(wide, hn::InterleaveUpper(d, a, b)); };
  auto stops = hn::Zero(d);
  for (std::size_t first = 0; first < packet.size; first += 8) {
    const float *r[8], *s[8];
    for (std::size_t i = 0; i < 8; ++i) {
      const std::size_t at = first + i < packet.size ? first + i : packet.size - 1;
      r[i] = reinterpret_cast<const float*>(packet.rays[at]);
      s[i] = reinterpret_cast<const float*>(&packet.rays[at]->stop);
    }
    // Four rays: fields 0 and 4, 1 and 5, 2 and 6, 3 and 7.
    V fields[2][4];
    for (std::size_t i = 0; i < 2; ++i) {
      const auto r0 = hn::LoadU(d, r[4 * i]), r1 = hn::LoadU(d, r[4 * i + 1]);
      const auto r2 = hn::LoadU(d, r[4 * i + 2]), r3 = hn::LoadU(d, r[4 * i + 3]);
      const auto low01 = lower(r0, r1), low23 = lower(r2, r3);
      const auto up01 = upper(r0, r1), up23 = upper(r2, r3);
      fields[i][0] = hn::BitCast(d, hn::InterleaveLower(wide, low01, low23));
      fields[i][1] = hn::BitCast(d, hn::InterleaveUpper(wide, low01, low23));
      fields[i][2] = hn::BitCast(d, hn::InterleaveLower(wide, up01, up23));
      fields[i][3] = hn::BitCast(d, hn::InterleaveUpper(wide, up01, up23));
    }
    const auto low = [&](int i)
                         HWY_ATTR { return hn::ConcatLowerLower(d, fields[1][i], fields[0][i]); };
    const auto high = [&](int i)
                          HWY_ATTR { return hn::ConcatUpperUpper(d, fields[1][i], fields[0][i]); };
    hn::Store(low(0), d, rays_.origin[0] + first);
    hn::Store(low(1), d, rays_.origin[1] + first);
    hn::Store(low(2), d, rays_.origin[2] + first);
    hn::Store(low(3), d, rays_.inverse[0] + first);
    hn::Store(high(0), d, rays_.inverse[1] + first);
    hn::Store(high(1), d, rays_.inverse[2] + first);
    hn::Store(high(2), d, rays_.t_min + first);
    const auto t_max = high(3);
    const hn::RebindToUnsigned<decltype(d)> du;
    const auto next = hn::BitCast(d, hn::Add(hn::BitCast(du, t_max), hn::Set(du, 1)));
    hn::Store(hn::IfThenElse(hn::Lt(t_max, hn::Set(d, HUGE_VALF)), next, t_max), d,
              rays_.t_end + first);

    const auto stop = [&](std::size_t i) HWY_ATTR {
      return hn::Combine(d, hn::LoadU(half, s[i + 4]), hn::LoadU(half, s[i]));
    };
    const auto stop01 = lower(stop(0), stop(1)), stop23 = lower(stop(2), stop(3));
    const auto start = hn::BitCast(d, hn::InterleaveLower(wide, stop01, stop23));
    const auto per_t = hn::BitCast(d, hn::InterleaveUpper(wide, stop01, stop23));
    hn::Store(start, d, rays_.stop_start + first);
    hn::Store(per_t, d, rays_.stop_per_t + first);
    stops = hn::Max(stops, hn::Max(start, per_t));
  }
  // Wider vectors may want more.
  for (std::size_t i = (packet.size + 7) / 8 * 8; i % kWidth != 0; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      rays_.origin[axis][i] = rays_.origin[axis][packet.size - 1];
      rays_.inverse[axis][i] = rays_.inverse[axis][packet.size - 1];
    }
    rays_.t_min[i] = rays_.t_min[packet.size - 1];
    rays_.t_end[i] = rays_.t_end[packet.size - 1];
    rays_.stop_start[i] = rays_.stop_start[packet.size - 1];
    rays_.stop_per_t[i] = rays_.stop_per_t[packet.size - 1];
  }
  rays_.size = packet.size;
  rays_.mirrored = packet.rays[0]->ray.mirrored;
  static constexpr MaskTable kMasks = mirrored_masks();
  mirrored_masks_ = kMasks[rays_.mirrored].data();
  rays_.coarsest = packet.rays[0]->stop.coarsest_level;
  rays_.has_stop = !hn::AllTrue(d, hn::Le(stops, hn::Zero(d)));
}

inline void PacketRays::bound(int levels) {
  const DF d;
  const auto range = [&](const float* values, float out[2]) HWY_ATTR {
    auto low = hn::Load(d, values), high = low;
    for (std::size_t i = kWidth; i < rays_.size; i += kWidth) {
      low = hn::Min(low, hn::Load(d, values + i));
      high = hn::Max(high, hn::Load(d, values + i));
    }
    out[0] = hn::GetLane(hn::MinOfLanes(d, low));
    out[1] = hn::GetLane(hn::MaxOfLanes(d, high));
  };
  width_at_start_ = width_per_t_ = 0;
  const auto range_by_axis = [&](const float(&values)[3][RayPacket::kMaxRays], Ranges& out) {
    for (int axis = 0; axis < 3; ++axis) {
      float ends[2];
      range(values[axis], ends);
      out.least[axis] = ends[0];
      out.most[axis] = ends[1];
    }
    out.least[3] = out.most[3] = 0;
  };
  range_by_axis(rays_.origin, origins_);
  range_by_axis(rays_.inverse, inverses_);
  for (int axis = 0; axis < 3; ++axis) {
    const float apart = origins_.most[axis] - origins_.least[axis];
    const float spread = 1 / inverses_.least[axis] - 1 / inverses_.most[axis];
    width_at_start_ = apart > width_at_start_ ? apart : width_at_start_;
    width_per_t_ = spread > width_per_t_ ? spread : width_per_t_;
  }
  float least[2], longest[2];
  range(rays_.t_min, least);
  range(rays_.t_end, longest);
  t_range_[0] = least[0];
  t_range_[1] = longest[1];
  last_t_min_ = least[1];
  stop_level_ = levels;
  if (!rays_.has_stop) return;
  range(rays_.stop_start, stop_start_);
  range(rays_.stop_per_t, stop_per_t_);
  // So that what it bounds grows with T.
  if (stop_per_t_[1] < 0) stop_per_t_[1] = 0;
  // T is at most 1 in the grid.
  const float most = (stop_start_[1] + stop_per_t_[1]) * (1 + 0x1p-10f);
  stop_level_ = rays_.coarsest;
  while (stop_level_ < levels && side_of(stop_level_) > most) ++stop_level_;
}

inline float PacketRays::last_exit(const Cell& cell) const {
  const hn::CappedTag<float, 4> d;
  const auto axes = hn::Load(D4(), kAxes);
  const auto lower = hn::BitCast(d, hn::And(load(cell), axes));
  const auto t = hn::Mul(hn::Sub(hn::Load(d, origins_.most), lower), hn::Load(d, inverses_.most));
  const auto is_axis = hn::MaskFromVec(hn::BitCast(d, axes));
  return hn::GetLane(hn::MinOfLanes(d, hn::IfThenElse(is_axis, t, hn::Set(d, HUGE_VALF))));
}

inline bool PacketRays::are_narrow(const Cell& cell, float enter) const {
  const hn::CappedTag<float, 4> d;
  const auto upper = hn::Add(load(cell), hn::Set(D4(), 1u << (23 - cell.level)));
  const auto distance =
      hn::Sub(hn::Load(d, origins_.least), hn::BitCast(d, hn::And(upper, hn::Load(D4(), kAxes))));
  const auto t = hn::Mul(distance, hn::Load(d, inverses_.least));
  enter = hn::GetLane(hn::MaxOfLanes(d, hn::Max(t, hn::Set(d, enter))));
  return width_at_start_ + width_per_t_ * enter < kNarrow * side_of(cell.level + 1);
}

#endif  // VOXDAG_PACKET_LANES

}  // namespace HWY_NAMESPACE
}  // namespace voxdag
HWY_AFTER_NAMESPACE();

#endif
