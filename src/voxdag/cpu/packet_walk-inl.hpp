// The walk of up to 64 rays of like direction: what its parts share. Included once for each
// instruction set, by cast_packet.cpp, which says how it goes.
#if defined(VOXDAG_PACKET_WALK_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXDAG_PACKET_WALK_INL
#undef VOXDAG_PACKET_WALK_INL
#else
#define VOXDAG_PACKET_WALK_INL
#endif

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <array>
#include <cmath>

#include "voxdag/cpu/ray_packet.hpp"

// The lanes are 8 or 16 rays, or the 8 voxels of an octant: smaller vectors are not worth it.
#undef VOXDAG_PACKET_LANES
#if HWY_MAX_BYTES >= 32 && HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
#define VOXDAG_PACKET_LANES 1
#else
#define VOXDAG_PACKET_LANES 0
#endif

HWY_BEFORE_NAMESPACE();
namespace voxdag {
namespace HWY_NAMESPACE {

#if VOXDAG_PACKET_LANES

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

#endif  // VOXDAG_PACKET_LANES

}  // namespace HWY_NAMESPACE
}  // namespace voxdag
HWY_AFTER_NAMESPACE();

#endif
