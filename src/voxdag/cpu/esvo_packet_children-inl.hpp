// A few rays of a packet, one after the other, against all children of a voxel at once: the lanes
// are the children.
#if defined(VOXDAG_ESVO_PACKET_CHILDREN_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXDAG_ESVO_PACKET_CHILDREN_INL
#undef VOXDAG_ESVO_PACKET_CHILDREN_INL
#else
#define VOXDAG_ESVO_PACKET_CHILDREN_INL
#endif

#include "voxdag/cpu/esvo_packet_walk-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace voxdag {
namespace HWY_NAMESPACE {

#if VOXDAG_PACKET_LANES

/// The shapes of a voxel's children, which are numbered as in its descriptor.
template <bool kWithContours>
struct EsvoPacketWalk<kWithContours>::ChildShapes {
  VF8 lower[3], upper[3];  ///< Their cubes.
  VI8 words, normal[3], length1, low, high;
  std::uint32_t with_contour;
};

template <bool kWithContours>
HWY_INLINE void EsvoPacketWalk<kWithContours>::set_child_shapes(const Visit& visit,
                                                                ChildDescriptor descriptor,
                                                                ChildShapes& shapes) const {
  const DF8 d;
  const DI8 di;
  const int bit = 22 - static_cast<int>(visit.level);
  const auto size = hn::Set(di, 1 << bit);
  VI8 corner[3], sign[3];
  for (int axis = 0; axis < 3; ++axis) {
    sign[axis] = hn::Set(di, -static_cast<std::int32_t>(rays_.mirrored >> axis & 1u));
    const auto is_upper = hn::Xor(hn::BitCast(di, hn::Load(DU8(), kUpper[axis])), sign[axis]);
    corner[axis] = hn::Add(hn::Set(di, static_cast<std::int32_t>(visit.corner[axis])),
                           hn::And(is_upper, size));
    shapes.lower[axis] = hn::BitCast(d, corner[axis]);
    shapes.upper[axis] = hn::BitCast(d, hn::Add(corner[axis], size));
  }
  shapes.with_contour = kWithContours ? descriptor.contour_mask() : 0;
  if (shapes.with_contour == 0) return;

  // The contours stand one after the other: each to the lane of its child.
  const auto* const words = reinterpret_cast<const std::int32_t*>(contours_of(visit, descriptor));
  const auto count = static_cast<std::size_t>(popcount8(shapes.with_contour));
  const auto listed = hn::MaskedLoad(hn::FirstN(di, count), di, words);
  const hn::Rebind<std::uint8_t, DI8> d_bytes;
  const auto places = hn::PromoteTo(di, hn::LoadU(d_bytes, kBefore[shapes.with_contour].data()));
  const auto w = hn::TableLookupLanes(listed, hn::IndicesFromVec(di, places));
  shapes.words = w;

  // ContourSlab::make, and the centres.
  const VI8 normal[3] = {hn::ShiftRight<26>(hn::ShiftLeft<26>(w)),
                         hn::ShiftRight<26>(hn::ShiftLeft<20>(w)),
                         hn::ShiftRight<26>(hn::ShiftLeft<14>(w))};
  const auto base = hn::Set(di, (1 << (bit - 1)) - static_cast<std::int32_t>(kOne));
  auto centre = hn::Zero(di), length1 = hn::Zero(di);
  for (int axis = 0; axis < 3; ++axis) {
    shapes.normal[axis] = hn::Sub(hn::Xor(normal[axis], sign[axis]), sign[axis]);
    length1 = hn::Add(length1, hn::Abs(normal[axis]));
    centre = hn::Add(centre, hn::Mul(shapes.normal[axis], hn::Add(corner[axis], base)));
  }
  shapes.length1 = length1;
  const auto position = hn::Set(di, Contour::kMaxPosition);
  const auto plane = [&](VI8 twice) HWY_ATTR {
    const auto steps = hn::Mul(length1, hn::Sub(twice, position));
    const auto at = hn::Mul(steps, hn::Set(di, ContourSlab::kStep));
    return hn::Add(centre, hn::ShiftRightSame(at, ContourSlab::kTopBit - bit));
  };
  const auto wider =
      hn::Add(hn::Set(di, ContourSlab::kWider),
              hn::ShiftRight<ContourSlab::kWiderShift>(hn::ShiftLeftSame(length1, bit - 1)));
  const auto twice_low = hn::And(hn::ShiftRight<17>(w), hn::Set(di, 2 * Contour::kMaxPosition)),
             twice_high = hn::And(hn::ShiftRight<24>(w), hn::Set(di, 2 * Contour::kMaxPosition));
  shapes.low = hn::Sub(plane(twice_low), wider);
  shapes.high = hn::Add(plane(twice_high), wider);
}

/// Ends those of `rays` that first meet a leaf or a voxel that they end at; returns them. Sets
/// which children the others meet.
template <bool kWithContours>
HWY_INLINE typename EsvoPacketWalk<kWithContours>::Rays
EsvoPacketWalk<kWithContours>::end_at_children(const Visit& visit, ChildDescriptor descriptor,
                                               Rays rays, ChildRays& children) {
  const DF8 d;
  const DI8 di;
  ChildShapes shapes;
  set_child_shapes(visit, descriptor, shapes);
  const Spans& spans = spans_below(visit.level);
  const std::uint32_t present = descriptor.valid_mask();
  const bool with_stop = static_cast<int>(visit.level) + 1 >= stop_level_;
  const auto side = hn::Set(d, side_of(visit.level + 1));
  const auto has_contour =
      hn::RebindMask(d, hn::Ne(hn::And(hn::Set(di, static_cast<std::int32_t>(shapes.with_contour)),
                                       hn::LoadU(di, kChildBits)),
                               hn::Zero(di)));
  for (Rays& meet : children.meet) meet = 0;
  Rays ended = 0;
  for (Rays rest = rays; rest != 0; rest &= rest - 1) {
    const auto i = static_cast<std::size_t>(lowest_bit64(rest));
    const auto t = [&](int axis, VF8 position) HWY_ATTR {
      return hn::Mul(hn::Sub(hn::Set(d, rays_.origin[axis][i]), position),
                     hn::Set(d, rays_.inverse[axis][i]));
    };
    const auto exit =
        hn::Min(hn::Min(t(0, shapes.lower[0]), t(1, shapes.lower[1])), t(2, shapes.lower[2]));
    const auto cube =
        hn::Max(hn::Max(t(0, shapes.upper[0]), t(1, shapes.upper[1])), t(2, shapes.upper[2]));
    auto enter = hn::Max(cube, hn::Set(d, spans.enter[i]));
    auto leave = hn::Min(exit, hn::Set(d, spans.leave[i]));
    std::uint32_t through_contour = 0;
    if (kWithContours && shapes.with_contour != 0) {
      const auto along = [&](const std::int32_t(&v)[3][RayPacket::kMaxRays]) HWY_ATTR {
        const auto xy = hn::Add(hn::Mul(shapes.normal[0], hn::Set(di, v[0][i])),
                                hn::Mul(shapes.normal[1], hn::Set(di, v[1][i])));
        return hn::Add(xy, hn::Mul(shapes.normal[2], hn::Set(di, v[2][i])));
      };
      VF8 cut_enter, cut_leave;
      cut(along(position_), along(direction_), exit, shapes.low, shapes.high, shapes.length1,
          cut_enter, cut_leave);
      const auto is_later = hn::And(has_contour, hn::Gt(cut_enter, enter));
      through_contour = bits_of_children(is_later);
      enter = hn::IfThenElse(is_later, cut_enter, enter);
      leave = hn::IfThenElse(has_contour, hn::Min(leave, cut_leave), leave);
    }
    const std::uint32_t met = bits_of_children(hn::Lt(enter, leave)) & present;
    if (met == 0) continue;
    std::uint32_t ends = descriptor.leaf_mask();
    if (with_stop) {
      const auto limit =
          hn::Add(hn::Set(d, rays_.stop_start[i]), hn::Mul(hn::Set(d, rays_.stop_per_t[i]), exit));
      ends |= bits_of_children(hn::Le(side, limit));
    }
    std::uint32_t in_order = mirrored(met);
    const auto child = static_cast<std::uint32_t>(highest_bit(in_order));
    const std::uint32_t index = child ^ rays_.mirrored;
    if ((ends >> index & 1u) == 0) {
      for (; in_order != 0; in_order &= in_order - 1)
        children.meet[lowest_bit64(in_order)] |= Rays{1} << i;
      continue;
    }
    ended |= Rays{1} << i;
    if (hits_ == nullptr) continue;
    alignas(32) float enters[8];
    hn::Store(enter, d, enters);
    EsvoHits& hits = *hits_;
    for (std::uint32_t axis = 0; axis < 3; ++axis)
      hits.corner[axis][i] =
          visit.corner[axis] | ((child >> axis & 1u) != 0 ? 1u << (22 - visit.level) : 0u);
    hits.t[i] = enters[index];
    hits.level[i] = static_cast<int>(visit.level + 1);
    hits.slot[i] = visit.slot;
    hits.child[i] = static_cast<std::uint8_t>(index);
    if constexpr (kWithContours) {
      if ((through_contour >> index & 1u) != 0)
        hits.plane[i] = {esvo_.contour(visit.slot, descriptor, static_cast<int>(index)),
                         hits.level[i]};
      else
        hits.plane[i] = plane_at(visit.level, i, enters[index]);
    }
  }
  return ended;
}

#endif  // VOXDAG_PACKET_LANES

}  // namespace HWY_NAMESPACE
}  // namespace voxdag
HWY_AFTER_NAMESPACE();

#endif
