// Tests a few rays of a packet, one after the other, against the cubes and contours of all children
// of a voxel at once: the children are the lanes.
#if defined(VOXDAG_ESVO_PACKET_CHILDREN_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXDAG_ESVO_PACKET_CHILDREN_INL
#undef VOXDAG_ESVO_PACKET_CHILDREN_INL
#else
#define VOXDAG_ESVO_PACKET_CHILDREN_INL
#endif

#include "voxdag/cpu/packets/esvo_packet_walk-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace voxdag {
namespace HWY_NAMESPACE {

#if VOXDAG_PACKET_LANES

/// The cubes of a voxel's children, in the order of its descriptor.
template <bool kWithContours, bool kOneOrigin>
struct EsvoPacketWalk<kWithContours, kOneOrigin>::ChildCubes {
  VI8 corner[3];           ///< Float bits.
  VF8 lower[3], upper[3];  ///< Positions of the sides; with kOneOrigin, their distances.
};

template <bool kWithContours, bool kOneOrigin>
HWY_INLINE void EsvoPacketWalk<kWithContours, kOneOrigin>::set_child_cubes(
    const Visit& visit, ChildCubes& cubes) const {
  const DF8 d;
  const DI8 di;
  const auto size = hn::Set(di, 1 << (22 - visit.level));
  for (int axis = 0; axis < 3; ++axis) {
    const auto is_upper =
        hn::Xor(hn::BitCast(di, hn::Load(DU8(), kUpper[axis])), hn::Set(di, sign_[axis]));
    cubes.corner[axis] = hn::Add(hn::Set(di, static_cast<std::int32_t>(visit.corner[axis])),
                                 hn::And(is_upper, size));
    cubes.lower[axis] = hn::BitCast(d, cubes.corner[axis]);
    cubes.upper[axis] = hn::BitCast(d, hn::Add(cubes.corner[axis], size));
    if constexpr (kOneOrigin) {
      const auto origin = hn::Set(d, origins_.least[axis]);
      cubes.lower[axis] = hn::Sub(origin, cubes.lower[axis]);
      cubes.upper[axis] = hn::Sub(origin, cubes.upper[axis]);
    }
  }
}

/// Decodes the children's contours, all eight at once. There must be at least one.
template <bool kWithContours, bool kOneOrigin>
HWY_INLINE void EsvoPacketWalk<kWithContours, kOneOrigin>::set_child_contours(
    const Visit& visit, ChildDescriptor descriptor, const ChildCubes& cubes) {
  const DI8 di;
  const int bit = 22 - static_cast<int>(visit.level);
  ChildContours& contours = child_contours_[visit.level];
  // Moves the contours, which are stored contiguously, to the lanes of their children.
  const std::uint32_t with_contour = descriptor.contour_mask();
  const auto* const words = reinterpret_cast<const std::int32_t*>(esvo_.slots) + 2 * visit.slot +
                            descriptor.contour_pointer();
  const auto count = static_cast<std::size_t>(popcount8(with_contour));
  const auto listed = hn::MaskedLoad(hn::FirstN(di, count), di, words);
  const hn::Rebind<std::uint8_t, DI8> d_bytes;
  const auto places = hn::PromoteTo(di, hn::LoadU(d_bytes, kBefore[with_contour].data()));
  const auto w = hn::TableLookupLanes(listed, hn::IndicesFromVec(di, places));
  hn::Store(w, di, contours.words);

  // Computes ContourSlab::make() and the voxels' centres.
  const VI8 normal[3] = {hn::ShiftRight<26>(hn::ShiftLeft<26>(w)),
                         hn::ShiftRight<26>(hn::ShiftLeft<20>(w)),
                         hn::ShiftRight<26>(hn::ShiftLeft<14>(w))};
  const std::int32_t base = (1 << (bit - 1)) - static_cast<std::int32_t>(kOne);
  auto centre = hn::Zero(di), length1 = hn::Zero(di);
  for (int axis = 0; axis < 3; ++axis) {
    const auto sign = hn::Set(di, sign_[axis]);
    const auto n = hn::Sub(hn::Xor(normal[axis], sign), sign);
    const auto from = hn::Set(di, kOneOrigin ? base - position_range_[axis][0] : base);
    centre = hn::Add(centre, hn::Mul(n, hn::Add(cubes.corner[axis], from)));
    length1 = hn::Add(length1, hn::Abs(n));
    hn::Store(n, di, contours.normal[axis]);
  }
  hn::Store(length1, di, contours.length1);
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
  hn::Store(hn::Sub(plane(twice_low), wider), di, contours.low);
  hn::Store(hn::Add(plane(twice_high), wider), di, contours.high);
}

/// Copies the spans that end_at_children() found for the parent to the visited voxel's level. Does
/// not set the common span of all rays, which is not used with few rays.
template <bool kWithContours, bool kOneOrigin>
HWY_INLINE void EsvoPacketWalk<kWithContours, kOneOrigin>::recall_spans(const Visit& visit,
                                                                        Rays rays) {
  const Tried& tried = tried_[visit.level - 1];
  const Spans& above = spans_below(visit.level - 1);
  Spans& here = spans_[visit.level];
  const std::uint32_t child = child_of(visit.corner, visit.level);
  for (; rays != 0; rays &= rays - 1) {
    const auto i = static_cast<std::size_t>(lowest_bit64(rays));
    const auto place = static_cast<std::size_t>(popcount64(tried.rays & ((Rays{1} << i) - 1)));
    here.enter[i] = tried.enter[place][child];
    here.leave[i] = tried.leave[place][child];
    if ((tried.by_contour[place] >> child & 1u) != 0)
      here.enter_level[i] = static_cast<std::int32_t>(visit.level);
    else
      here.enter_level[i] = (tried.by_cube[place] >> child & 1u) != 0 ? 0 : above.enter_level[i];
  }
}

/// Ends the rays whose first hit is a leaf, or a voxel at which the level of detail ends them.
/// Returns these rays. Sets the children that the other rays meet.
template <bool kWithContours, bool kOneOrigin>
HWY_INLINE typename EsvoPacketWalk<kWithContours, kOneOrigin>::Rays
EsvoPacketWalk<kWithContours, kOneOrigin>::end_at_children(const Visit& visit,
                                                           ChildDescriptor descriptor,
                                                           const ChildCubes& cubes, Rays rays,
                                                           bool may_stop, ChildRays& children) {
  const DF8 d;
  const DI8 di;
  const std::uint32_t with_contour = kWithContours ? descriptor.contour_mask() : 0;
  const ChildContours& contours = child_contours_[kWithContours ? visit.level : 0];
  const Spans& spans = spans_below(visit.level);
  const std::uint32_t present = descriptor.valid_mask();
  const auto side = hn::Set(d, side_of(visit.level + 1));
  const auto has_contour =
      hn::RebindMask(d, hn::Ne(hn::And(hn::Set(di, static_cast<std::int32_t>(with_contour)),
                                       hn::LoadU(di, kChildBits)),
                               hn::Zero(di)));
  for (Rays& meet : children.meet) meet = 0;
  children.met = 0;
  Tried& tried = tried_[kWithContours ? visit.level : 0];
  tried.rays = rays;
  Rays ended = 0;
  std::size_t place = 0;
  for (Rays rest = rays; rest != 0; rest &= rest - 1, ++place) {
    const auto i = static_cast<std::size_t>(lowest_bit64(rest));
    const auto t = [&](int axis, VF8 plane) HWY_ATTR {
      if constexpr (!kOneOrigin) plane = hn::Sub(hn::Set(d, rays_.origin[axis][i]), plane);
      return hn::Mul(plane, hn::Set(d, rays_.inverse[axis][i]));
    };
    const auto exit =
        hn::Min(hn::Min(t(0, cubes.lower[0]), t(1, cubes.lower[1])), t(2, cubes.lower[2]));
    const auto cube =
        hn::Max(hn::Max(t(0, cubes.upper[0]), t(1, cubes.upper[1])), t(2, cubes.upper[2]));
    auto enter = hn::Max(cube, hn::Set(d, spans.enter[i]));
    auto leave = hn::Min(exit, hn::Set(d, spans.leave[i]));
    std::uint32_t through_contour = 0;
    if (kWithContours && with_contour != 0) {
      const auto along = [&](const std::int32_t(&v)[3][RayPacket::kMaxRays]) HWY_ATTR {
        const auto part = [&](int axis) HWY_ATTR {
          return hn::Mul(hn::Load(di, contours.normal[axis]), hn::Set(di, v[axis][i]));
        };
        return hn::Add(hn::Add(part(0), part(1)), part(2));
      };
      VF8 cut_enter, cut_leave;
      const auto position = kOneOrigin ? hn::Zero(di) : along(position_);
      cut(position, along(direction_), exit, hn::Load(di, contours.low),
          hn::Load(di, contours.high), hn::Load(di, contours.length1), cut_enter, cut_leave);
      const auto is_later = hn::And(has_contour, hn::Gt(cut_enter, enter));
      through_contour = bits_of_children(is_later);
      enter = hn::IfThenElse(is_later, cut_enter, enter);
      leave = hn::IfThenElse(has_contour, hn::Min(leave, cut_leave), leave);
      hn::Store(enter, d, tried.enter[place]);
      hn::Store(leave, d, tried.leave[place]);
      tried.by_contour[place] = through_contour;
      tried.by_cube[place] = bits_of_children(hn::Gt(cube, hn::Set(d, spans.enter[i])));
    }
    const std::uint32_t met = bits_of_children(hn::Lt(enter, leave)) & present;
    if (met == 0) continue;
    std::uint32_t ends = descriptor.leaf_mask();
    if (may_stop) {
      const auto limit =
          hn::Add(hn::Set(d, rays_.stop_start[i]), hn::Mul(hn::Set(d, rays_.stop_per_t[i]), exit));
      ends |= bits_of_children(hn::Le(side, limit));
    }
    std::uint32_t in_order = mirrored(met);
    const auto child = static_cast<std::uint32_t>(highest_bit(in_order));
    const std::uint32_t index = child ^ rays_.mirrored;
    if ((ends >> index & 1u) == 0) {
      children.met |= in_order;
      for (; in_order != 0; in_order &= in_order - 1)
        children.meet[lowest_bit64(in_order)] |= Rays{1} << i;
      continue;
    }
    ended |= Rays{1} << i;
    if (hits_ == nullptr) continue;
    alignas(32) float enters[8];
    hn::Store(enter, d, enters);
    EsvoHits& hits = *hits_;
    Cell cell;
    set_child(visit, child, cell);
    for (std::uint32_t axis = 0; axis < 3; ++axis) hits.corner[axis][i] = cell.corner[axis];
    hits.t[i] = enters[index];
    hits.level[i] = static_cast<int>(visit.level + 1);
    hits.slot[i] = visit.slot;
    hits.child[i] = static_cast<std::uint8_t>(index);
    if constexpr (kWithContours) {
      if ((through_contour >> index & 1u) != 0)
        hits.plane[i] = {Contour{static_cast<std::uint32_t>(contours.words[index])}, hits.level[i]};
      else
        hits.plane[i] = plane_at(visit, i, enters[index]);
    }
  }
  return ended;
}

#endif  // VOXDAG_PACKET_LANES

}  // namespace HWY_NAMESPACE
}  // namespace voxdag
HWY_AFTER_NAMESPACE();

#endif
