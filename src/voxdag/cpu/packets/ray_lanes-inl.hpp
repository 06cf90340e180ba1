// The rays of a packet in lanes: a structure of arrays, so that a vector holds one value of up to
// 16 rays. Included once for each instruction set.
#if defined(VOXDAG_RAY_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXDAG_RAY_LANES_INL
#undef VOXDAG_RAY_LANES_INL
#else
#define VOXDAG_RAY_LANES_INL
#endif

#include <cmath>

#include "voxdag/cpu/packets/packet_lanes-inl.hpp"
#include "voxdag/cpu/packets/ray_packet.hpp"

HWY_BEFORE_NAMESPACE();
namespace voxdag {
namespace HWY_NAMESPACE {

#if VOXDAG_PACKET_LANES

/// Returns whether all rays start at one point, in mirrored coordinates.
inline bool have_one_origin(const RayPacket& packet) {
  static_assert(offsetof(GridRay, origin) == 0 && sizeof(GridRay) >= 16);
  const hn::CappedTag<float, 4> d;
  const auto origin = [&](std::size_t i) HWY_ATTR {
    return hn::LoadU(d, reinterpret_cast<const float*>(packet.rays[i]));
  };
  const auto first = origin(0);
  std::uint8_t bits[8] = {};
  for (std::size_t i = 1; i < packet.size; ++i) {
    hn::StoreMaskBits(d, hn::Ne(origin(i), first), bits);
    if ((bits[0] & 7u) != 0) return false;
  }
  return true;
}

struct RayLanes {
  static constexpr std::size_t kWidth = hn::MaxLanes(hn::CappedTag<float, 16>());  ///< Lanes.

  /// Indexed by axis, then by ray. The last vector is padded with copies of the last ray.
  alignas(64) float origin[3][RayPacket::kMaxRays], inverse[3][RayPacket::kMaxRays];
  alignas(64) float t_min[RayPacket::kMaxRays];
  /// The next float after t_max: a ray meets a cell only if it enters before t_end.
  alignas(64) float t_end[RayPacket::kMaxRays];
  alignas(64) float stop_start[RayPacket::kMaxRays], stop_per_t[RayPacket::kMaxRays];
  std::size_t size;
  std::uint32_t mirrored;
  int coarsest;   ///< The coarsest level of the levels of detail.
  bool has_stop;  ///< Whether any ray has a level of detail.

  /// Sets all values. The packet must have at least one ray.
  void load(const RayPacket& packet);
};

/// Transposes eight rays at a time: the first eight floats of each, then their levels of detail.
inline void RayLanes::load(const RayPacket& packet) {
  static_assert(offsetof(GridRay, origin) == 0 && offsetof(GridRay, inverse) == 12 &&
                offsetof(GridRay, t_min) == 24 && offsetof(GridRay, t_max) == 28);
  static_assert(offsetof(CastRay, ray) == 0 && offsetof(StopBelowSize, at_start) == 0 &&
                offsetof(StopBelowSize, per_t) == 4 &&
                offsetof(CastRay, stop) + 16 <= sizeof(CastRay));
  const hn::CappedTag<float, 8> d;
  const hn::Half<decltype(d)> half;
  const hn::RepartitionToWide<decltype(d)> wide;
  using V = hn::Vec<decltype(d)>;
  const auto lower = [&](V a, V b)
                         HWY_ATTR { return hn::BitCast(wide, hn::InterleaveLower(d, a, b)); };
  const auto upper = [&](V a, V b)
                         HWY_ATTR { return hn::BitCast(wide, hn::InterleaveUpper(d, a, b)); };
  auto stops = hn::Zero(d);
  for (std::size_t first = 0; first < packet.size; first += 8) {
    const float *r[8], *s[8];
    for (std::size_t i = 0; i < 8; ++i) {
      const std::size_t at = first + i < packet.size ? first + i : packet.size - 1;
      r[i] = reinterpret_cast<const float*>(packet.rays[at]);
      s[i] = reinterpret_cast<const float*>(&packet.rays[at]->stop);
    }
    // Four rays: fields 0 and 4, 1 and 5, 2 and 6, 3 and 7.
    V fields[2][4];
    for (std::size_t i = 0; i < 2; ++i) {
      const auto r0 = hn::LoadU(d, r[4 * i]), r1 = hn::LoadU(d, r[4 * i + 1]);
      const auto r2 = hn::LoadU(d, r[4 * i + 2]), r3 = hn::LoadU(d, r[4 * i + 3]);
      const auto low01 = lower(r0, r1), low23 = lower(r2, r3);
      const auto up01 = upper(r0, r1), up23 = upper(r2, r3);
      fields[i][0] = hn::BitCast(d, hn::InterleaveLower(wide, low01, low23));
      fields[i][1] = hn::BitCast(d, hn::InterleaveUpper(wide, low01, low23));
      fields[i][2] = hn::BitCast(d, hn::InterleaveLower(wide, up01, up23));
      fields[i][3] = hn::BitCast(d, hn::InterleaveUpper(wide, up01, up23));
    }
    const auto low = [&](int i)
                         HWY_ATTR { return hn::ConcatLowerLower(d, fields[1][i], fields[0][i]); };
    const auto high = [&](int i)
                          HWY_ATTR { return hn::ConcatUpperUpper(d, fields[1][i], fields[0][i]); };
    hn::Store(low(0), d, origin[0] + first);
    hn::Store(low(1), d, origin[1] + first);
    hn::Store(low(2), d, origin[2] + first);
    hn::Store(low(3), d, inverse[0] + first);
    hn::Store(high(0), d, inverse[1] + first);
    hn::Store(high(1), d, inverse[2] + first);
    hn::Store(high(2), d, t_min + first);
    const auto t_max = high(3);
    const hn::RebindToUnsigned<decltype(d)> du;
    const auto next = hn::BitCast(d, hn::Add(hn::BitCast(du, t_max), hn::Set(du, 1)));
    hn::Store(hn::IfThenElse(hn::Lt(t_max, hn::Set(d, HUGE_VALF)), next, t_max), d, t_end + first);

    const auto stop = [&](std::size_t i) HWY_ATTR {
      return hn::Combine(d, hn::LoadU(half, s[i + 4]), hn::LoadU(half, s[i]));
    };
    const auto stop01 = lower(stop(0), stop(1)), stop23 = lower(stop(2), stop(3));
    const auto start = hn::BitCast(d, hn::InterleaveLower(wide, stop01, stop23));
    const auto per_t = hn::BitCast(d, hn::InterleaveUpper(wide, stop01, stop23));
    hn::Store(start, d, stop_start + first);
    hn::Store(per_t, d, stop_per_t + first);
    stops = hn::Max(stops, hn::Max(start, per_t));
  }
  // Pads the last vector if vectors are wider.
  for (std::size_t i = (packet.size + 7) / 8 * 8; i % kWidth != 0; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      origin[axis][i] = origin[axis][packet.size - 1];
      inverse[axis][i] = inverse[axis][packet.size - 1];
    }
    t_min[i] = t_min[packet.size - 1];
    t_end[i] = t_end[packet.size - 1];
    stop_start[i] = stop_start[packet.size - 1];
    stop_per_t[i] = stop_per_t[packet.size - 1];
  }
  size = packet.size;
  mirrored = packet.rays[0]->ray.mirrored;
  coarsest = packet.rays[0]->stop.coarsest_level;
  has_stop = !hn::AllTrue(d, hn::Le(stops, hn::Zero(d)));
}

#endif  // VOXDAG_PACKET_LANES

}  // namespace HWY_NAMESPACE
}  // namespace voxdag
HWY_AFTER_NAMESPACE();

#endif
