// The rays of a packet into lanes, and what they met out of them.
#if defined(VOXDAG_PACKET_LOAD_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXDAG_PACKET_LOAD_INL
#undef VOXDAG_PACKET_LOAD_INL
#else
#define VOXDAG_PACKET_LOAD_INL
#endif

#include "voxdag/cpu/packet_walk-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace voxdag {
namespace HWY_NAMESPACE {

#if VOXDAG_PACKET_LANES

/// Transposes eight rays at a time: the first eight floats of each, then its level of detail.
inline void PacketWalk::load(const DagPacket& packet) {
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
    hn::Store(low(0), d, rays_.origin[0] + first);
    hn::Store(low(1), d, rays_.origin[1] + first);
    hn::Store(low(2), d, rays_.origin[2] + first);
    hn::Store(low(3), d, rays_.inverse[0] + first);
    hn::Store(high(0), d, rays_.inverse[1] + first);
    hn::Store(high(1), d, rays_.inverse[2] + first);
    hn::Store(high(2), d, rays_.t_min + first);
    const auto t_max = high(3);
    const hn::RebindToUnsigned<decltype(d)> du;
    const auto next = hn::BitCast(d, hn::Add(hn::BitCast(du, t_max), hn::Set(du, 1)));
    hn::Store(hn::IfThenElse(hn::Lt(t_max, hn::Set(d, HUGE_VALF)), next, t_max), d,
              rays_.t_end + first);

    const auto stop = [&](std::size_t i) HWY_ATTR {
      return hn::Combine(d, hn::LoadU(half, s[i + 4]), hn::LoadU(half, s[i]));
    };
    const auto stop01 = lower(stop(0), stop(1)), stop23 = lower(stop(2), stop(3));
    const auto start = hn::BitCast(d, hn::InterleaveLower(wide, stop01, stop23));
    const auto per_t = hn::BitCast(d, hn::InterleaveUpper(wide, stop01, stop23));
    hn::Store(start, d, rays_.stop_start + first);
    hn::Store(per_t, d, rays_.stop_per_t + first);
    stops = hn::Max(stops, hn::Max(start, per_t));
  }
  // Wider vectors may want more.
  for (std::size_t i = (packet.size + 7) / 8 * 8; i % kWidth != 0; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      rays_.origin[axis][i] = rays_.origin[axis][packet.size - 1];
      rays_.inverse[axis][i] = rays_.inverse[axis][packet.size - 1];
    }
    rays_.t_min[i] = rays_.t_min[packet.size - 1];
    rays_.t_end[i] = rays_.t_end[packet.size - 1];
    rays_.stop_start[i] = rays_.stop_start[packet.size - 1];
    rays_.stop_per_t[i] = rays_.stop_per_t[packet.size - 1];
  }
  rays_.size = packet.size;
  rays_.mirrored = packet.rays[0]->ray.mirrored;
  rays_.coarsest = packet.rays[0]->stop.coarsest_level;
  rays_.has_stop = !hn::AllTrue(d, hn::Le(stops, hn::Zero(d)));
}

/// Sets T of the hits, as entered_face() in trace/cast.hpp finds it.
inline void PacketWalk::set_hit_t() {
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
