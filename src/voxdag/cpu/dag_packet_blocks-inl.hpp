// The rays of a packet against the voxels of a leaf block.
#if defined(VOXDAG_DAG_PACKET_BLOCKS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXDAG_DAG_PACKET_BLOCKS_INL
#undef VOXDAG_DAG_PACKET_BLOCKS_INL
#else
#define VOXDAG_DAG_PACKET_BLOCKS_INL
#endif

#include "voxdag/cpu/dag_packet_boxes-inl.hpp"
#include "voxdag/cpu/dag_packet_walk-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace voxdag {
namespace HWY_NAMESPACE {

#if VOXDAG_PACKET_LANES

/// Casts rays, one by one, at the 4³ voxels of a block; lane i of a vector is voxel i of an octant.
/// Ends those that meet one, or an octant that they end at.
inline void DagPacketWalk::cast_in_block(const Visit& visit) {
  const int levels = nodes_.levels();
  const std::uint64_t block = mirrored_block(nodes_.block(visit.node), rays_.mirrored);
  const std::uint32_t* corner = visit.corner;
  const bool may_end_at_octants = (visit.skipped & kOctantsMayEnd) != 0;
  // Whoever meets an octant meets a voxel's place in it.
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

  for (Rays rest = visit.rays; rest != 0; rest &= rest - 1) {
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
        return corner[axis] + ((first >> axis & 1u) | (first >> (2 + axis) & 2u)) * size;
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
  const int level = nodes_.levels() - 2;
  set_planes(visit.corner, level, hn::Zero(DU8()));
  const std::uint32_t met = bound_children(level + 1).met;
  end_at_children(visit, met & mirrored(nodes_.child_mask(visit.node, level)));
}

/// Sets T of the hits, as entered_face() in trace/cast.hpp finds it.
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
