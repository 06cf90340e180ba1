// The rays of a packet with bounds on all of them: the base class of the packet walks at DAGs and
// ESVOs. Included once for each instruction set.
//
// Source: I. Wald, P. Slusallek, C. Benthin and M. Wagner, "Interactive Rendering with Coherent Ray
// Tracing", Eurographics 2001, for packets; A. Reshetov, A. Soupikov and J. Hurley, "Multi-Level
// Ray Tracing Algorithm", SIGGRAPH 2005, for bounds on a packet by interval arithmetic.
//
// All rays of a packet are mirrored on the same axes and run down along every axis. So the least
// and greatest origin and inverse direction per axis bound the T at which any ray crosses a plane.
// While the rays are close together, compared with the cells, a walk tests a cell with these bounds
// alone. After they have spread, it tests them one vector at a time.
#if defined(VOXDAG_PACKET_RAYS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXDAG_PACKET_RAYS_INL
#undef VOXDAG_PACKET_RAYS_INL
#else
#define VOXDAG_PACKET_RAYS_INL
#endif

#include <array>

#include "voxdag/cpu/packets/ray_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace voxdag {
namespace HWY_NAMESPACE {

#if VOXDAG_PACKET_LANES

class PacketRays : protected PacketLanes {
 protected:
  using Rays = Set;
  using DF8 = hn::CappedTag<float, 8>;  ///< Lanes are the children of a node.
  using DU8 = hn::RebindToUnsigned<DF8>;
  static_assert(hn::MaxLanes(DF8()) == 8);
  /// Rays whose distance is less than this many sides of a cell are tested as one wide ray.
  static constexpr float kNarrow = 1.0f;
  /// Up to this many rays are tested one at a time, each against all children of a node at once.
  static constexpr int kFew = 6;
  static constexpr std::uint32_t kOne = 0x3F800000u;  ///< The bits of 1.0f.

  using D4 = hn::CappedTag<std::uint32_t, 4>;
  /// A cell. Its words are loaded and stored as one vector.
  struct alignas(16) Cell {
    std::uint32_t corner[3];  ///< Float bits.
    std::uint32_t level;
  };
  static_assert(sizeof(Cell) == 16);
  /// The least and the greatest value of all rays, by axis; the fourth lane is 0.
  struct alignas(16) Ranges {
    float least[4], most[4];
  };

  /// Loads the rays of a packet, which must have at least one.
  void load(const RayPacket& packet);
  /// Computes the bounds on the rays. `levels` is L, or more.
  void bound(int levels);
  /// Returns whether the rays are so close together, compared with the children of this cell, that
  /// testing them separately does not pay. No ray enters the cell before `enter`.
  bool are_narrow(const Cell& cell, float enter) const;
  /// Returns a T at which all rays that meet the cell have left it.
  float last_exit(const Cell& cell) const;
  /// Returns whether any ray is beyond the first two vectors. If not, testing rays separately is as
  /// fast as using the bounds.
  static bool are_many(Rays rays) { return (rays >> (2 * kWidth - 1) >> 1) != 0; }

  /// Narrows the bounds `enter` and `exit` of the T at which rays are in boxes, one box per lane,
  /// by the boxes' sides on an axis. The bounds hold in float arithmetic, because rounding is
  /// monotone.
  HWY_INLINE void bound_by_sides(int axis, hn::Vec<DF8> low, hn::Vec<DF8> high, hn::Vec<DF8>& enter,
                                 hn::Vec<DF8>& exit) const {
    const DF8 d;
    bound_by_distances(axis, hn::Sub(hn::Set(d, origins_.least[axis]), high),
                       hn::Sub(hn::Set(d, origins_.most[axis]), low), enter, exit);
  }
  /// Narrows the bounds, given the least distances down to the upper sides and the greatest
  /// distances down to the lower sides.
  HWY_INLINE void bound_by_distances(int axis, hn::Vec<DF8> to_high, hn::Vec<DF8> to_low,
                                     hn::Vec<DF8>& enter, hn::Vec<DF8>& exit) const {
    const DF8 d;
    const auto slow = hn::Set(d, inverses_.most[axis]), fast = hn::Set(d, inverses_.least[axis]);
    enter = hn::Max(enter, hn::Mul(to_high, hn::IfNegativeThenElse(to_high, slow, fast)));
    exit = hn::Min(exit, hn::Mul(to_low, hn::IfNegativeThenElse(to_low, fast, slow)));
  }

  /// Returns the mask whose bit i is bit i ^ mirrored of `mask`.
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
  /// Mask of the first three words.
  alignas(16) static constexpr std::uint32_t kAxes[4] = {~0u, ~0u, ~0u, 0};
  /// Mask, by axis and child: all bits set for children in the upper half.
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
    // By child and axis: whether the child's side is added to the corner.
    alignas(16) static constexpr std::uint32_t kBits[8][4] = {
        {0, 0, 0, 0},   {~0u, 0, 0, 0},   {0, ~0u, 0, 0},   {~0u, ~0u, 0, 0},
        {0, 0, ~0u, 0}, {~0u, 0, ~0u, 0}, {0, ~0u, ~0u, 0}, {~0u, ~0u, ~0u, 0}};
    alignas(16) static constexpr std::uint32_t kNextLevel[4] = {0, 0, 0, 1};
    const D4 d;
    const auto side = hn::Set(d, 1u << (22 - parent.level));
    const auto first = hn::Add(load(parent), hn::Load(d, kNextLevel));
    store(hn::Or(first, hn::And(hn::Load(d, kBits[child]), side)), cell);
  }

  RayLanes rays_;
  const std::uint8_t* mirrored_masks_;  ///< The mirrored mask of each mask.
  Ranges origins_, inverses_;
  /// The least t_min and the greatest t_end.
  float t_range_[2];
  float stop_start_[2], stop_per_t_[2];
  float last_t_min_;
  int stop_level_;  ///< The coarsest level at which the level of detail may end a ray; else
                    ///< `levels`.
  float width_at_start_, width_per_t_;  ///< The rays are about start + per_t * T apart.
};

inline void PacketRays::load(const RayPacket& packet) {
  rays_.load(packet);
  static constexpr MaskTable kMasks = mirrored_masks();
  mirrored_masks_ = kMasks[rays_.mirrored].data();
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
  // Makes the bound grow with T.
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
