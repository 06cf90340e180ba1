// The walk of a packet of rays at a DAG: its state, and the functions that its parts share. See
// cast_dag_packet.cpp for the algorithm. Included once for each instruction set.
#if defined(VOXDAG_DAG_PACKET_WALK_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXDAG_DAG_PACKET_WALK_INL
#undef VOXDAG_DAG_PACKET_WALK_INL
#else
#define VOXDAG_DAG_PACKET_WALK_INL
#endif

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>

#include "voxdag/cpu/packets/bounded_dag.hpp"
#include "voxdag/cpu/packets/dag_packet.hpp"
#include "voxdag/cpu/packets/in_place_dag.hpp"
#include "voxdag/cpu/packets/packet_rays-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace voxdag {
namespace HWY_NAMESPACE {

#if VOXDAG_PACKET_LANES

class DagPacketWalk : PacketRays {
 public:
  /// `hits` is null if the caller only wants to know which rays meet anything.
  DagPacketWalk(const BoundedDag& dag, PacketHits* hits)
      : words_(dag.words()),
        leaf_blocks_(dag.nodes().view().leaf_blocks),
        levels_(dag.levels()),
        is_empty_(dag.nodes().is_empty()),
        hits_(hits) {}
  DagPacketWalk(const InPlaceDag& dag, UnitCache& units, PacketHits* hits)
      : words_(dag.words()),
        levels_(dag.levels()),
        is_empty_(dag.is_empty()),
        unit_level_(dag.unit_level()),
        in_place_(&dag),
        units_(&units),
        hits_(hits) {}

  Rays cast(const RayPacket& packet);

 private:
  /// A node to visit.
  struct alignas(32) Visit : Cell {
    Rays rays;
    std::uint32_t node;
    std::uint32_t
        skipped;  ///< Mask of the children to skip, by mirrored index, and the flags below.
  };
  /// Flags in Visit::skipped: the rays end at this cell; all rays end at the octants of this leaf
  /// block; some rays may end at its octants.
  static constexpr std::uint32_t kEndsHere = 0x100, kOctantsEnd = 0x200, kOctantsMayEnd = 0x400;
  /// Masks of the children of a node, by their mirrored index.
  struct Children {
    std::uint32_t met;       ///< Children that any ray can meet.
    std::uint32_t all_end;   ///< Children where every ray that meets them ends.
    std::uint32_t some_end;  ///< Children at which any ray can end.
    std::uint32_t octants_end,
        octants_may_end;  ///< Leaf blocks at whose octants rays end or may end.
  };
  /// A cell, defined by the bits that all positions in it share.
  struct CommonCell {
    std::uint32_t corner[3];
    int level;  ///< The level of the finest cell that holds all positions.
  };

  /// The number of children stored before a child. Indexed by `mirrored`, the node's child mask and
  /// the mirrored child index.
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
  /// Returns the block with every octant filled that has a voxel.
  static std::uint64_t filled_octants(std::uint64_t block) {
    block |= block >> 4 & 0x0F0F0F0F0F0F0F0Fu;
    block |= block >> 2 & 0x3333333333333333u;
    block |= block >> 1 & 0x5555555555555555u;
    return (block & 0x0101010101010101u) * 0xFF;
  }
  /// Returns the coordinate along an axis, in [0,4), of a voxel in its leaf block.
  static constexpr std::uint32_t place_of(std::uint32_t voxel, std::uint32_t axis) {
    return (voxel >> axis & 1u) | (voxel >> (2 + axis) & 2u);
  }
  /// Applies mirrored_mask() to both levels of a leaf block.
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

  /// Returns the words of a node above the leaf blocks.
  HWY_INLINE const std::uint32_t* words_of(std::uint32_t node, int level) const {
    return (level < unit_level_ ? words_ : unit_words_) + 2 * std::size_t{node};
  }
  /// Decodes the unit with this number: words_of() then finds the nodes in it. The unit is node 0.
  HWY_NOINLINE void open_unit(std::uint32_t number) {
    const DecodedUnit& unit = units_->unit(*in_place_, number);
    unit_words_ = unit.words;
    leaf_blocks_ = unit.leaf_blocks;
  }

  void common_cells(CommonCell& starts, CommonCell& reach, int finest) const;
  int finest_without_stop() const;
  std::size_t begin(Rays all, Visit* stack);
  void walk();
  HWY_INLINE void set_planes(const std::uint32_t corner[3], int level, hn::Vec<DU8> boxes);
  HWY_INLINE Children bound_children(int child_level) const;
  HWY_INLINE void cut_by_boxes(int i, hn::Vec<DF8>& enter, hn::Vec<DF8>& exit) const;
  HWY_INLINE std::uint32_t boxes_met_by(int i) const;
  HWY_INLINE Children children_met_by(int i, int child_level) const;
  HWY_INLINE Rays rays_meeting(std::uint32_t child, Rays rays) const;
  HWY_NOINLINE Rays rays_ending(std::uint32_t child, int child_level, Rays rays) const;
  void visit_children(const Visit& visit, Visit* stack, std::size_t& top);
  void end_at_children(const Visit& visit, std::uint32_t met);
  void cast_in_block(const Visit& visit);
  void cast_vector_in_block(const std::uint32_t corner[3], std::uint64_t block, std::size_t first,
                            Rays rays);
  void cast_one_by_one_in_block(const Visit& visit, std::uint64_t block, Rays rays);
  void end_at_octants(const Visit& visit);
  HWY_INLINE void set_ends(int child_level, hn::Vec<DF8> enter, hn::Vec<DF8> exit,
                           const float start[2], const float per_t[2], Children& children) const;
  /// Returns whether ray i ends at the cell of `level` with the lower corner `low`. The ray must
  /// meet the cell.
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

  const std::uint32_t* words_;                  ///< Words of the nodes above the units.
  const std::uint64_t* leaf_blocks_ = nullptr;  ///< Leaf blocks of the DAG, or of the open unit.
  int levels_;
  bool is_empty_;
  int unit_level_ = kMaxLevels;  ///< Finer than all nodes if the DAG is not compact.
  const InPlaceDag* in_place_ = nullptr;
  UnitCache* units_ = nullptr;
  const std::uint32_t* unit_words_ = nullptr;  ///< Words of the open unit.
  PacketHits* hits_;
  Rays searching_ = 0;              ///< Rays that have not met anything yet.
  alignas(64) float planes_[6][8];  ///< The planes of the current boxes: the lower ones by axis,
                                    ///< then the upper.
};

#endif  // VOXDAG_PACKET_LANES

}  // namespace HWY_NAMESPACE
}  // namespace voxdag
HWY_AFTER_NAMESPACE();

#endif
