// Tests the rays of a packet, as lanes, against a voxel's cube and contour, and its children's
// cubes.
#if defined(VOXDAG_ESVO_PACKET_CELLS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXDAG_ESVO_PACKET_CELLS_INL
#undef VOXDAG_ESVO_PACKET_CELLS_INL
#else
#define VOXDAG_ESVO_PACKET_CELLS_INL
#endif

#include "voxdag/cpu/packets/esvo_packet_walk-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace voxdag {
namespace HWY_NAMESPACE {

#if VOXDAG_PACKET_LANES

/// Computes ContourSlab::slack().
template <bool kWithContours, bool kOneOrigin>
template <class VFloat, class VInt>
HWY_INLINE VInt EsvoPacketWalk<kWithContours, kOneOrigin>::slack_of(VInt length1, VFloat exit) {
  const hn::DFromV<VFloat> d;
  const hn::DFromV<VInt> di;
  const auto base = hn::Set(d, ContourSlab::kReachBase);
  const auto reach = hn::Sub(hn::BitCast(di, hn::Add(exit, base)), hn::BitCast(di, base));
  return hn::ShiftRight<ContourSlab::kReachShift>(hn::Mul(length1, hn::Add(reach, hn::Set(di, 1))));
}

/// Computes ContourRay::span(): the T between the planes, for rays with n.O = position and n.d =
/// speed.
template <bool kWithContours, bool kOneOrigin>
template <class VFloat, class VInt>
HWY_INLINE void EsvoPacketWalk<kWithContours, kOneOrigin>::cut(VInt position, VInt speed,
                                                               VFloat exit, VInt low, VInt high,
                                                               VInt length1, VFloat& enter,
                                                               VFloat& leave) {
  const hn::DFromV<VFloat> d;
  const hn::DFromV<VInt> di;
  const auto slack = slack_of(length1, exit);
  const auto fall = hn::ConvertTo(d, hn::Or(speed, hn::Set(di, 1)));
  const auto inverse = hn::Div(hn::Set(d, 2.0f), fall);
  const auto above_high = hn::Sub(hn::Sub(position, high), slack),
             above_low = hn::Add(hn::Sub(position, low), slack);
  const auto t_high = hn::Mul(hn::ConvertTo(d, above_high), inverse),
             t_low = hn::Mul(hn::ConvertTo(d, above_low), inverse);
  enter = hn::Min(t_high, t_low);
  leave = hn::Max(t_high, t_low);
}

/// Returns which of `rays` meet the voxel's shape and, with kWithStop, which of these end at it.
/// kCut means that the voxel has a contour: then sets the spans of its level.
template <bool kWithContours, bool kOneOrigin>
template <bool kCut, bool kWithStop>
HWY_INLINE typename EsvoPacketWalk<kWithContours, kOneOrigin>::Rays
EsvoPacketWalk<kWithContours, kOneOrigin>::clip(const Visit& visit, Rays rays, Rays& stopped) {
  const DF d;
  const DI di;
  const std::uint32_t level = visit.level;
  const int bit = 23 - static_cast<int>(level);
  VF lower[3], upper[3];
  for (int axis = 0; axis < 3; ++axis) {
    lower[axis] = to_plane(d, axis, visit.corner[axis]);
    upper[axis] = to_plane(d, axis, visit.corner[axis] + (1u << bit));
  }
  const Spans& above = spans_below(level - 1);
  Spans& here = spans_[kCut ? level : 0];
  VI normal[3], low, high, length1;
  if constexpr (kCut) {
    const ChildContours& contours = child_contours_[level - 1];
    const std::uint32_t child = child_of(visit.corner, level);
    for (int axis = 0; axis < 3; ++axis) normal[axis] = hn::Set(di, contours.normal[axis][child]);
    low = hn::Set(di, contours.low[child]);
    high = hn::Set(di, contours.high[child]);
    length1 = hn::Set(di, contours.length1[child]);
  }
  auto first = hn::Set(d, HUGE_VALF), last = hn::Zero(d);
  Rays met = 0;
  stopped = 0;
  for (Rays rest = rays; rest != 0;) {
    const std::size_t at = take_vector(rest);
    VF enters[3], exits[3];
    for (int axis = 0; axis < 3; ++axis) {
      const auto inverse = hn::Load(d, rays_.inverse[axis] + at);
      enters[axis] = hn::Mul(distance(axis, at, upper[axis]), inverse);
      exits[axis] = hn::Mul(distance(axis, at, lower[axis]), inverse);
    }
    const auto exit = hn::Min(hn::Min(exits[0], exits[1]), exits[2]);
    auto enter = hn::Max(hn::Max(enters[0], enters[1]), enters[2]);
    const auto above_enter = hn::Load(d, above.enter + at);
    const auto by_cube = hn::RebindMask(di, hn::Gt(enter, above_enter));
    enter = hn::Max(enter, above_enter);
    auto leave = hn::Min(exit, hn::Load(d, above.leave + at));
    if constexpr (kCut) {
      const auto along = [&](const std::int32_t(&v)[3][RayPacket::kMaxRays]) HWY_ATTR {
        const auto xy = hn::Add(hn::Mul(normal[0], hn::Load(di, v[0] + at)),
                                hn::Mul(normal[1], hn::Load(di, v[1] + at)));
        return hn::Add(xy, hn::Mul(normal[2], hn::Load(di, v[2] + at)));
      };
      VF cut_enter, cut_leave;
      const auto position = kOneOrigin ? hn::Zero(di) : along(position_);
      cut(position, along(direction_), exit, low, high, length1, cut_enter, cut_leave);
      const auto by_contour = hn::RebindMask(di, hn::Gt(cut_enter, enter));
      const auto enter_level = hn::IfThenZeroElse(by_cube, hn::Load(di, above.enter_level + at));
      hn::Store(
          hn::IfThenElse(by_contour, hn::Set(di, static_cast<std::int32_t>(level)), enter_level),
          di, here.enter_level + at);
      enter = hn::Max(enter, cut_enter);
      leave = hn::Min(leave, cut_leave);
      hn::Store(enter, d, here.enter + at);
      hn::Store(leave, d, here.leave + at);
      const auto is_met = hn::Lt(enter, leave);
      first = hn::Min(first, hn::IfThenElse(is_met, enter, first));
      last = hn::Max(last, hn::IfThenElseZero(is_met, leave));
    }
    met |= bits_of(hn::Lt(enter, leave)) << at;
    if constexpr (kWithStop) {
      const auto limit = hn::Add(hn::Load(d, rays_.stop_start + at),
                                 hn::Mul(hn::Load(d, rays_.stop_per_t + at), exit));
      stopped |= bits_of(hn::Le(hn::Set(d, side_of(level)), limit)) << at;
    }
  }
  met &= rays;
  if (kCut && are_many(met)) {
    here.first = hn::GetLane(hn::MinOfLanes(d, first));
    here.last = hn::GetLane(hn::MaxOfLanes(d, last));
  }
  stopped &= met;
  return met;
}

/// Finds which of `rays` meet which cubes of the children that exist.
template <bool kWithContours, bool kOneOrigin>
HWY_INLINE void EsvoPacketWalk<kWithContours, kOneOrigin>::intersect(const Visit& visit,
                                                                     const Spans& spans, Rays rays,
                                                                     ChildRays& children) const {
  const DF d;
  const std::uint32_t half = 1u << (22 - visit.level);
  const auto plane = [&](int axis, std::uint32_t i)
                         HWY_ATTR { return to_plane(d, axis, visit.corner[axis] + i * half); };
  const auto x0 = plane(0, 0), x1 = plane(0, 1), x2 = plane(0, 2);
  const auto y0 = plane(1, 0), y1 = plane(1, 1), y2 = plane(1, 2);
  const auto z0 = plane(2, 0), z1 = plane(2, 1), z2 = plane(2, 2);
  Rays m0 = 0, m1 = 0, m2 = 0, m3 = 0, m4 = 0, m5 = 0, m6 = 0, m7 = 0;
  for (Rays rest = rays; rest != 0;) {
    const std::size_t first = take_vector(rest);
    const auto t = [&](int axis, VF position) HWY_ATTR {
      return hn::Mul(distance(axis, first, position), hn::Load(d, rays_.inverse[axis] + first));
    };
    const auto tx0 = t(0, x0), tx1 = t(0, x1), tx2 = t(0, x2);
    const auto ty0 = t(1, y0), ty1 = t(1, y1), ty2 = t(1, y2);
    const auto tz0 = t(2, z0), tz1 = t(2, z1), tz2 = t(2, z2);
    const auto begin = hn::Load(d, spans.enter + first), end = hn::Load(d, spans.leave + first);
    const auto enter_z0 = hn::Max(tz1, begin), enter_z1 = hn::Max(tz2, begin);
    const auto exit_z0 = hn::Min(tz0, end), exit_z1 = hn::Min(tz1, end);
    // Two children, one above the other.
    const auto column = [&](VF enter_xy, VF exit_xy, Rays& lower, Rays& upper) HWY_ATTR {
      lower |= bits_of(hn::Lt(hn::Max(enter_xy, enter_z0), hn::Min(exit_xy, exit_z0))) << first;
      upper |= bits_of(hn::Lt(hn::Max(enter_xy, enter_z1), hn::Min(exit_xy, exit_z1))) << first;
    };
    column(hn::Max(tx1, ty1), hn::Min(tx0, ty0), m0, m4);
    column(hn::Max(tx2, ty1), hn::Min(tx1, ty0), m1, m5);
    column(hn::Max(tx1, ty2), hn::Min(tx0, ty1), m2, m6);
    column(hn::Max(tx2, ty2), hn::Min(tx1, ty1), m3, m7);
  }
  children.meet[0] = m0 & rays;
  children.meet[1] = m1 & rays;
  children.meet[2] = m2 & rays;
  children.meet[3] = m3 & rays;
  children.meet[4] = m4 & rays;
  children.meet[5] = m5 & rays;
  children.meet[6] = m6 & rays;
  children.meet[7] = m7 & rays;
  const hn::CappedTag<std::uint64_t, 4> d4;
  std::uint8_t met[2][8];
  for (std::size_t half_of_them = 0; half_of_them < 2; ++half_of_them)
    hn::StoreMaskBits(d4, hn::Ne(hn::LoadU(d4, children.meet + 4 * half_of_them), hn::Zero(d4)),
                      met[half_of_them]);
  children.met &= met[0][0] | static_cast<std::uint32_t>(met[1][0]) << 4;
}

#endif  // VOXDAG_PACKET_LANES

}  // namespace HWY_NAMESPACE
}  // namespace voxdag
HWY_AFTER_NAMESPACE();

#endif
