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
#include <bit>
#include <cmath>
#include <cstddef>

#include "voxdag/cpu/bounded_dag.hpp"
#include "voxdag/cpu/dag_packet.hpp"

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
  /// `hits` is null where it is only asked which rays meet anything.
  PacketWalk(const BoundedDag& dag, DagHits* hits)
      : nodes_(dag.nodes()), words_(dag.words()), hits_(hits) {}

  Rays cast(const DagPacket& packet);

 private:
  /// The rays, by axis, then by ray; the last vector is filled up with copies of the last ray.
  struct Lanes {
    alignas(64) float origin[3][DagPacket::kMaxRays], inverse[3][DagPacket::kMaxRays];
    alignas(64) float t_min[DagPacket::kMaxRays];
    /// The next float after t_max: a cell is met if it is entered before that.
    alignas(64) float t_end[DagPacket::kMaxRays];
    alignas(64) float stop_start[DagPacket::kMaxRays], stop_per_t[DagPacket::kMaxRays];
    std::size_t size;
    std::uint32_t mirrored;
    int coarsest;  ///< Of the levels of detail.
    bool has_stop;
  };
  /// A node to visit.
  struct alignas(32) Visit {
    Rays rays;
    std::uint32_t node;
    std::uint32_t skipped;    ///< Children not to look at, mirrored.
    std::uint32_t corner[3];  ///< Float bits.
    std::uint32_t level;
  };
  /// In Visit::skipped: the rays end at this cell; of a leaf block, they end at its octants, or
  /// some may.
  static constexpr std::uint32_t kEndsHere = 0x100, kOctantsEnd = 0x200, kOctantsMayEnd = 0x400;
  /// Of the children of a node, by their mirrored index.
  struct Children {
    std::uint32_t met;       ///< Those that any ray can meet.
    std::uint32_t all_end;   ///< Those at which all rays end that meet them.
    std::uint32_t some_end;  ///< Those at which any ray can end.
    std::uint32_t octants_end,
        octants_may_end;  ///< Leaf blocks of which the same holds for octants.
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
  static HWY_INLINE std::uint32_t bits_of_lanes(hn::Mask<hn::CappedTag<float, 8>> mask) {
    std::uint8_t bits[8];
    hn::StoreMaskBits(hn::CappedTag<float, 8>(), mask, bits);
    return bits[0];
  }
  /// By `mirrored` and a node's child mask, then by mirrored child index, the number of children
  /// that are stored before that child.
  using RankTable = std::array<std::array<std::array<std::uint8_t, 8>, 256>, 8>;
  static constexpr RankTable ranks() {
    RankTable table{};
    for (std::uint32_t m = 0; m < 8; ++m)
      for (std::uint32_t mask = 0; mask < 256; ++mask)
        for (std::uint32_t child = 0; child < 8; ++child)
          table[m][mask][child] =
              static_cast<std::uint8_t>(std::popcount(mask & ((1u << (child ^ m)) - 1)) & 7);
    return table;
  }
  const std::uint8_t* ranks_of(std::uint32_t mask) const {
    alignas(64) static constexpr RankTable kRanks = ranks();
    return kRanks[rays_.mirrored][mask].data();
  }
  using MaskTable = std::array<std::array<std::uint8_t, 256>, 8>;
  static constexpr MaskTable mirrored_masks() {
    MaskTable table{};
    for (std::uint32_t m = 0; m < 8; ++m)
      for (std::uint32_t mask = 0; mask < 256; ++mask)
        table[m][mask] = static_cast<std::uint8_t>(mirrored_mask(mask, m));
    return table;
  }
  std::uint32_t mirrored(std::uint32_t mask) const {
    static constexpr MaskTable kMasks = mirrored_masks();
    return kMasks[rays_.mirrored][mask];
  }
  static float side_of(int level) {
    return float_from_bits(static_cast<std::uint32_t>(127 - level) << 23);
  }
  /// Sets all voxels of the octants that have any.
  static std::uint64_t filled_octants(std::uint64_t block) {
    block |= block >> 4 & 0x0F0F0F0F0F0F0F0Fu;
    block |= block >> 2 & 0x3333333333333333u;
    block |= block >> 1 & 0x5555555555555555u;
    return (block & 0x0101010101010101u) * 0xFF;
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

  void load(const DagPacket& packet);
  void bound();
  bool is_narrow(const std::uint32_t corner[3], int level) const;
  void common_cells(CommonCell& starts, CommonCell& reach, int finest) const;
  int finest_without_stop() const;
  std::size_t begin(Rays all, Visit* stack) const;
  void walk();
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
  /// Lanes are the children of a node.
  using DChild = hn::CappedTag<std::uint32_t, 8>;
  using DPlane = hn::CappedTag<float, 8>;
  static_assert(hn::MaxLanes(DChild()) == 8);
  HWY_INLINE void set_planes(const std::uint32_t corner[3], int level, hn::Vec<DChild> boxes);
  HWY_INLINE Children bound_children(int child_level) const;
  HWY_INLINE std::uint32_t boxes_met_by(int i) const;
  HWY_INLINE Children children_met_by(int i, int child_level) const;
  HWY_INLINE Rays rays_meeting(std::uint32_t child, Rays rays) const;
  Rays rays_ending(std::uint32_t child, int child_level, Rays rays) const;
  void visit_children(const Visit& visit, Visit* stack, std::size_t& top);
  void end_at_children(const Visit& visit, std::uint32_t met);
  void cast_in_block(const Visit& visit);
  void end_at_octants(const Visit& visit);
  HWY_INLINE void set_ends(int child_level, hn::Vec<DPlane> enter, hn::Vec<DPlane> exit,
                           const float start[2], const float per_t[2], Children& children) const;
  /// Whether ray i ends at the cell of this level with the lower corner `low`, which it meets.
  bool ends_at(int i, const float low[3], int level) const {
    if (level < rays_.coarsest) return false;
    float exit = HUGE_VALF;
    for (int axis = 0; axis < 3; ++axis) {
      const float t = (rays_.origin[axis][i] - low[axis]) * rays_.inverse[axis][i];
      exit = t < exit ? t : exit;
    }
    return side_of(level) <= rays_.stop_start[i] + rays_.stop_per_t[i] * exit;
  }
  void end(Rays rays, const std::uint32_t corner[3], int level) {
    searching_ &= ~rays;
    if (hits_ == nullptr) return;
    for (; rays != 0; rays &= rays - 1) {
      const int i = lowest_bit64(rays);
      for (int axis = 0; axis < 3; ++axis) hits_->corner[axis][i] = corner[axis];
      hits_->level[i] = level;
    }
  }
  void set_hit_t();

  const SvdagNodes& nodes_;
  const std::uint32_t* words_;
  DagHits* hits_;
  Lanes rays_;
  Rays searching_ = 0;              ///< Those that have not met anything.
  alignas(64) float planes_[6][8];  ///< Of the boxes at hand: the lower ones by axis, the upper.
  /// Least and greatest of all rays, by axis, then of t_min and t_end.
  float origin_range_[3][2], inverse_range_[3][2], t_range_[2];
  float stop_start_[2], stop_per_t_[2];
  float last_t_min_;
  int stop_level_;  ///< No ray ends above this level; L where they all end at voxels.
  float width_at_start_, width_per_t_;  ///< About how far apart the rays are at T.
};

#endif  // VOXDAG_PACKET_LANES

}  // namespace HWY_NAMESPACE
}  // namespace voxdag
HWY_AFTER_NAMESPACE();

#endif
