// Tests many rays of a packet that are close together as one wide ray, the hull, against all
// children of a voxel at once: the children are the lanes.
#if defined(VOXDAG_ESVO_PACKET_HULL_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXDAG_ESVO_PACKET_HULL_INL
#undef VOXDAG_ESVO_PACKET_HULL_INL
#else
#define VOXDAG_ESVO_PACKET_HULL_INL
#endif

#include "voxdag/cpu/packets/esvo_packet_children-inl.hpp"
#include "voxdag/cpu/packets/esvo_packet_walk-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace voxdag {
namespace HWY_NAMESPACE {

#if VOXDAG_PACKET_LANES

/// Returns the children whose cubes any ray can meet.
template <bool kWithContours, bool kOneOrigin>
inline std::uint32_t EsvoPacketWalk<kWithContours, kOneOrigin>::cubes_met_by_hull(
    const Visit& visit, const Spans& spans) const {
  const DF8 d;
  const DU8 du;
  const auto half = hn::Set(du, 1u << (22 - visit.level));
  auto enter = hn::Set(d, spans.first), exit = hn::Set(d, spans.last);
  for (int axis = 0; axis < 3; ++axis) {
    const auto low =
        hn::Or(hn::Set(du, visit.corner[axis]), hn::And(hn::Load(du, kUpper[axis]), half));
    const auto high = hn::Add(low, half);
    bound_by_sides(axis, hn::BitCast(d, low), hn::BitCast(d, high), enter, exit);
  }
  return bits_of_children(hn::Lt(enter, exit));
}

/// Returns the children whose shapes any ray can meet.
///
/// While the rays are in a child's cube, n.(O - C) - T n.d lies in an interval given by the ranges
/// of O, d and T. If that interval is above or below both planes of the contour, no ray comes
/// between them.
///
/// Why rounding does not matter: the planes are at least as far out as those of ContourRay::span
/// for the ray that leaves the cube last, at T = cube_exit. They are moved outwards again by s + 1
/// with s > 8 |n| T + |n| / 256 - 1, in units of 2^-23. The rounding errors are smaller. Those of
/// ContourRay::span are 2 |n| T for the quotient and T / 2 for n.d, which is made odd; those of
/// this function are 2 |n| T for two conversions and two products.
template <bool kWithContours, bool kOneOrigin>
HWY_INLINE std::uint32_t EsvoPacketWalk<kWithContours, kOneOrigin>::shapes_met_by_hull(
    const Visit& visit, std::uint32_t with_contour, const ChildCubes& cubes,
    const Spans& spans) const {
  const DF8 d;
  const DI8 di;
  // T is at most 1 in the grid. The slack depends on where the rays leave the cube, even if their
  // ranges end before.
  auto enter = hn::Set(d, spans.first), cube_exit = hn::Set(d, 1.0f);
  for (int axis = 0; axis < 3; ++axis) {
    if constexpr (kOneOrigin)
      bound_by_distances(axis, cubes.upper[axis], cubes.lower[axis], enter, cube_exit);
    else
      bound_by_sides(axis, cubes.lower[axis], cubes.upper[axis], enter, cube_exit);
  }
  const auto exit = hn::Min(cube_exit, hn::Set(d, spans.last));
  const std::uint32_t in_cube = bits_of_children(hn::Lt(enter, exit));
  if ((in_cube & with_contour) == 0) return mirrored(in_cube);

  const ChildContours& contours = child_contours_[kWithContours ? visit.level : 0];
  auto least = hn::Zero(di), most = hn::Zero(di), slowest = hn::Zero(di), fastest = hn::Zero(di);
  for (int axis = 0; axis < 3; ++axis) {
    const auto add_range = [&](const std::int32_t(&range)[2], VI8& low, VI8& high) HWY_ATTR {
      const auto n = hn::Load(di, contours.normal[axis]);
      const auto a = hn::Mul(n, hn::Set(di, range[0])), b = hn::Mul(n, hn::Set(di, range[1]));
      low = hn::Add(low, hn::Min(a, b));
      high = hn::Add(high, hn::Max(a, b));
    };
    if constexpr (!kOneOrigin) add_range(position_range_[axis], least, most);
    add_range(direction_range_[axis], slowest, fastest);
  }
  const auto slack = slack_of(hn::Load(di, contours.length1), cube_exit);
  const auto twice = hn::Add(hn::Add(slack, slack), hn::Set(di, 1));
  // T n.d is in units of 2^-24.
  const auto half = hn::Set(d, 0.5f);
  const auto slow = hn::Mul(hn::ConvertTo(d, slowest), half),
             fast = hn::Mul(hn::ConvertTo(d, fastest), half);
  const auto lowest = hn::Sub(hn::ConvertTo(d, hn::Sub(least, hn::Load(di, contours.high))),
                              hn::Max(hn::Mul(fast, enter), hn::Mul(fast, exit)));
  const auto highest = hn::Sub(hn::ConvertTo(d, hn::Sub(most, hn::Load(di, contours.low))),
                               hn::Min(hn::Mul(slow, enter), hn::Mul(slow, exit)));
  const auto reach = hn::ConvertTo(d, twice);
  const auto is_between = hn::And(hn::Le(lowest, reach), hn::Ge(highest, hn::Neg(reach)));
  return mirrored(in_cube & (bits_of_children(is_between) | ~with_contour));
}

#endif  // VOXDAG_PACKET_LANES

}  // namespace HWY_NAMESPACE
}  // namespace voxdag
HWY_AFTER_NAMESPACE();

#endif
