// The rays of a packet against a node's children, and against the voxels of a leaf block.
#if defined(VOXDAG_PACKET_CELLS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXDAG_PACKET_CELLS_INL
#undef VOXDAG_PACKET_CELLS_INL
#else
#define VOXDAG_PACKET_CELLS_INL
#endif

#include "voxdag/cpu/packet_walk-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace voxdag {
namespace HWY_NAMESPACE {

#if VOXDAG_PACKET_LANES

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

#endif  // VOXDAG_PACKET_LANES

}  // namespace HWY_NAMESPACE
}  // namespace voxdag
HWY_AFTER_NAMESPACE();

#endif
