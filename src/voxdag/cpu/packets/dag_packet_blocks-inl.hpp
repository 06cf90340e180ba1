// Tests the rays of a packet against the voxels of a leaf block. With many rays, the lanes are
// rays, tested against one voxel after the other; with few, the lanes are the voxels of an octant,
// tested against one ray.
#if defined(VOXDAG_DAG_PACKET_BLOCKS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXDAG_DAG_PACKET_BLOCKS_INL
#undef VOXDAG_DAG_PACKET_BLOCKS_INL
#else
#define VOXDAG_DAG_PACKET_BLOCKS_INL
#endif

#include "voxdag/cpu/packets/dag_packet_boxes-inl.hpp"
#include "voxdag/cpu/packets/dag_packet_walk-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace voxdag {
namespace HWY_NAMESPACE {

#if VOXDAG_PACKET_LANES

/// Casts rays at the 4³ voxels of a block. With many rays per voxel it tests vectors of rays
/// against one voxel after the other, else single rays against all voxels. Ends the rays that meet
/// a voxel, or an octant at which the level of detail ends them.
inline void DagPacketWalk::cast_in_block(const Visit& visit) {
  const std::uint64_t block = mirrored_block(leaf_blocks_[visit.node], rays_.mirrored);
  Rays others = visit.rays;
  if ((visit.skipped & kOctantsMayEnd) == 0) {
    // Measured costs, in units of one test of a vector against a voxel: the overhead of a vector,
    // and that of a single ray.
    constexpr int kVectorCost = 12, kRayCost = 12;
    const int cost = kVectorCost + popcount64(block);
    for (Rays rest = visit.rays; rest != 0;) {
      const std::size_t first = take_vector(rest);
      const Rays lanes = visit.rays & kVector << first;
      if (kRayCost * popcount64(lanes) <= cost) continue;
      cast_vector_in_block(visit.corner, block, first, lanes);
      others &= ~lanes;
    }
  }
  if (others != 0) cast_one_by_one_in_block(visit, block, others);
}

/// Casts `rays`, all of one vector, at the voxels of a block at `corner`.
inline void DagPacketWalk::cast_vector_in_block(const std::uint32_t corner[3], std::uint64_t block,
                                                std::size_t first, Rays rays) {
  const DF d;
  const hn::RebindToUnsigned<DF> du;
  const hn::RebindToSigned<DF> di;
  const std::uint32_t size = 1u << (23 - levels_);
  // T at which rays enter and leave the slabs of voxels, indexed by axis, then by coordinate, then
  // by ray.
  alignas(64) float enter[12 * kWidth], exit[12 * kWidth];
  const auto t_min = hn::Load(d, rays_.t_min + first), t_end = hn::Load(d, rays_.t_end + first);
  for (int axis = 0; axis < 3; ++axis) {
    const auto origin = hn::Load(d, rays_.origin[axis] + first),
               inverse = hn::Load(d, rays_.inverse[axis] + first);
    for (std::uint32_t i = 0; i <= 4; ++i) {
      const auto plane = hn::Set(d, float_from_bits(corner[axis] + i * size));
      const auto t = hn::Mul(hn::Sub(origin, plane), inverse);
      const std::size_t at = (4 * static_cast<std::size_t>(axis) + i) * kWidth;
      if (i > 0) hn::Store(axis == 0 ? hn::Max(t, t_min) : t, d, enter + at - kWidth);
      if (i < 4) hn::Store(axis == 0 ? hn::Min(t, t_end) : t, d, exit + at);
    }
  }
  // The index at which the lanes of a voxel's slab begin, for each voxel and axis.
  static constexpr auto kLanes = [] {
    std::array<std::array<std::uint8_t, 3>, 64> lanes{};
    for (std::uint32_t voxel = 0; voxel < 64; ++voxel)
      for (std::uint32_t axis = 0; axis < 3; ++axis)
        lanes[voxel][axis] = static_cast<std::uint8_t>((4 * axis + place_of(voxel, axis)) * kWidth);
    return lanes;
  }();
  // Tests the farthest voxel first: nearer voxels overwrite the result, so the nearest one remains.
  auto nearest = hn::Set(di, -1);
  for (std::uint64_t rest = block; rest != 0; rest &= rest - 1) {
    const auto voxel = static_cast<std::uint32_t>(lowest_bit64(rest));
    const std::uint8_t* at = kLanes[voxel].data();
    const auto of = [&](const float* t, int axis) HWY_ATTR { return hn::Load(d, t + at[axis]); };
    const auto in = hn::Max(hn::Max(of(enter, 0), of(enter, 1)), of(enter, 2));
    const auto out = hn::Min(hn::Min(of(exit, 0), of(exit, 1)), of(exit, 2));
    nearest = hn::IfThenElse(hn::RebindMask(di, hn::Lt(in, out)),
                             hn::Set(di, static_cast<std::int32_t>(voxel)), nearest);
  }
  const auto is_met = hn::Gt(nearest, hn::Set(di, -1));
  const Rays met = bits_of(hn::RebindMask(d, is_met)) << first & rays;
  searching_ &= ~met;
  if (hits_ == nullptr || met == 0) return;
  const auto voxel = hn::BitCast(du, nearest);
  const auto one = hn::Set(du, 1), two = hn::Set(du, 2);
  const auto ends = hn::And(is_met, lanes_of(di, rays >> first));
  for (int axis = 0; axis < 3; ++axis) {
    // place_of()
    const auto place = hn::Or(hn::And(hn::ShiftRightSame(voxel, axis), one),
                              hn::And(hn::ShiftRightSame(voxel, axis + 2), two));
    const auto low = hn::Add(hn::Set(du, corner[axis]), hn::Mul(place, hn::Set(du, size)));
    std::uint32_t* corners = hits_->corner[axis] + first;
    hn::Store(hn::IfThenElse(hn::RebindMask(du, ends), low, hn::Load(du, corners)), du, corners);
  }
  std::int32_t* levels = hits_->level + first;
  hn::Store(hn::IfThenElse(ends, hn::Set(di, levels_), hn::Load(di, levels)), di, levels);
}

/// Casts rays one at a time at the voxels of a block; lane i of a vector is voxel i of an octant.
inline void DagPacketWalk::cast_one_by_one_in_block(const Visit& visit, std::uint64_t block,
                                                    Rays rays) {
  const int levels = levels_;
  const std::uint32_t* corner = visit.corner;
  const bool may_end_at_octants = (visit.skipped & kOctantsMayEnd) != 0;
  // A ray that meets an octant meets one of its 2³ voxels, which may be set or not.
  const std::uint64_t octants = may_end_at_octants ? filled_octants(block) : block;
  const hn::CappedTag<float, 8> d;
  constexpr std::size_t kBlockLanes = hn::MaxLanes(d);
  static_assert(kBlockLanes == 8);
  alignas(32) static constexpr std::uint32_t kOffset[3][8] = {
      {0, 1, 0, 1, 0, 1, 0, 1}, {0, 0, 1, 1, 0, 0, 1, 1}, {0, 0, 0, 0, 1, 1, 1, 1}};
  const hn::RebindToUnsigned<decltype(d)> du;
  const std::uint32_t size = 1u << (23 - levels);
  hn::Vec<decltype(d)> lower[3][2], upper[3][2];
  for (int axis = 0; axis < 3; ++axis)
    for (std::uint32_t octant = 0; octant < 2; ++octant) {
      const auto offset = hn::Add(hn::Load(du, kOffset[axis]), hn::Set(du, 2 * octant));
      const auto low = hn::Add(hn::Set(du, corner[axis]), hn::Mul(offset, hn::Set(du, size)));
      lower[axis][octant] = hn::BitCast(d, low);
      upper[axis][octant] = hn::BitCast(d, hn::Add(low, hn::Set(du, size)));
    }

  for (Rays rest = rays; rest != 0; rest &= rest - 1) {
    const int i = lowest_bit64(rest);
    hn::Vec<decltype(d)> enter[3][2], exit[3][2];
    for (int axis = 0; axis < 3; ++axis) {
      const auto origin = hn::Set(d, rays_.origin[axis][i]),
                 inverse = hn::Set(d, rays_.inverse[axis][i]);
      for (int octant = 0; octant < 2; ++octant) {
        enter[axis][octant] = hn::Mul(hn::Sub(origin, upper[axis][octant]), inverse);
        exit[axis][octant] = hn::Mul(hn::Sub(origin, lower[axis][octant]), inverse);
      }
    }
    const auto t_min = hn::Set(d, rays_.t_min[i]), t_end = hn::Set(d, rays_.t_end[i]);
    for (int octant = 0; octant < 2; ++octant) {
      enter[2][octant] = hn::Max(enter[2][octant], t_min);
      exit[2][octant] = hn::Min(exit[2][octant], t_end);
    }
    std::uint64_t met = 0;
    for (int xy = 0; xy < 4; ++xy) {
      const auto enter_xy = hn::Max(enter[0][xy & 1], enter[1][xy >> 1]);
      const auto exit_xy = hn::Min(exit[0][xy & 1], exit[1][xy >> 1]);
      for (int z = 0; z < 2; ++z)
        met |= static_cast<std::uint64_t>(bits_of_children(
                   hn::Lt(hn::Max(enter_xy, enter[2][z]), hn::Min(exit_xy, exit[2][z]))))
               << (8 * (xy + 4 * z));
    }
    met &= octants;
    while (met != 0) {
      auto first = static_cast<std::uint32_t>(63 - __builtin_clzll(met));
      const std::uint64_t octant = std::uint64_t{0xFF} << (first & 56u);
      const auto at = [&](std::uint32_t axis) {
        return corner[axis] + place_of(first, axis) * size;
      };
      if (may_end_at_octants) {
        first &= 56u;
        const std::uint32_t cell[3] = {at(0), at(1), at(2)};
        const float low[3] = {float_from_bits(cell[0]), float_from_bits(cell[1]),
                              float_from_bits(cell[2])};
        if (ends_at(i, low, levels - 1)) {
          end(Rays{1} << i, cell, levels - 1);
          break;
        }
        const std::uint64_t voxels = met & octant & block;
        if (voxels == 0) {
          met &= ~octant;
          continue;
        }
        first = static_cast<std::uint32_t>(63 - __builtin_clzll(voxels));
      }
      const std::uint32_t cell[3] = {at(0), at(1), at(2)};
      end(Rays{1} << i, cell, levels);
      break;
    }
  }
}

/// Ends rays at the octants of a block that they meet.
inline void DagPacketWalk::end_at_octants(const Visit& visit) {
  const int level = levels_ - 2;
  set_planes(visit.corner, level, hn::Zero(DU8()));
  std::uint32_t met = mirrored(leaf_block_child_mask(leaf_blocks_[visit.node]));
  if (popcount64(visit.rays) > kFew) met &= bound_children(level + 1).met;
  end_at_children(visit, met);
}

/// Sets T of the hits to the plane that entered_face() in trace/cast.hpp finds.
inline void DagPacketWalk::set_hit_t() {
  const DF d;
  const hn::RebindToUnsigned<DF> du;
  const hn::RebindToSigned<DF> di;
  for (std::size_t i = 0; i < rays_.size; i += kWidth) {
    const auto shift = hn::Sub(hn::Set(di, 23), hn::LoadU(di, hits_->level + i));
    const auto side = hn::Shl(hn::Set(du, 1), hn::BitCast(du, shift));
    auto t = hn::Load(d, rays_.t_min + i);
    for (int axis = 0; axis < 3; ++axis) {
      const auto upper = hn::BitCast(d, hn::Add(hn::LoadU(du, hits_->corner[axis] + i), side));
      t = hn::Max(t, hn::Mul(hn::Sub(hn::Load(d, rays_.origin[axis] + i), upper),
                             hn::Load(d, rays_.inverse[axis] + i)));
    }
    hn::Store(t, d, hits_->t + i);
  }
}

#endif  // VOXDAG_PACKET_LANES

}  // namespace HWY_NAMESPACE
}  // namespace voxdag
HWY_AFTER_NAMESPACE();

#endif
