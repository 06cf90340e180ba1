// Casts up to 64 rays of like direction at an ESVO together. Compiled once for each instruction
// set; the best that the machine has is chosen at run time.
//
// As in cast_dag_packet.cpp the rays run down the same way along every axis once mirrored, so that
// one depth-first walk, nearest children first, serves all of them: a descriptor is read, and a
// contour decoded, once for all rays in the voxel. A ray meets a voxel's shape just when the range
// of T that the contours of its ancestors, its cube and its own contour leave is not empty; that is
// what the walk of one ray in trace/esvo_cast.hpp finds, to the bit, whose products these are.
//
// A contour is looked at when its voxel is visited, not when its parent is: by then rays that end
// nearer by are gone. What it leaves of the rays' ranges is kept for its level, as the voxels below
// are visited before any other of that level. Where only a few rays are left it is the other way
// round: one ray after the other is tried at all children, and their contours, at once.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "voxdag/cpu/cast_esvo_packet.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "voxdag/cpu/esvo_packet.hpp"
#include "voxdag/cpu/esvo_packet_cells-inl.hpp"
#include "voxdag/cpu/esvo_packet_children-inl.hpp"
#include "voxdag/cpu/esvo_packet_walk-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace voxdag {
namespace HWY_NAMESPACE {

#if VOXDAG_PACKET_LANES

/// Sets spans 0, and the rays as ContourRay has them.
template <bool kWithContours>
void EsvoPacketWalk<kWithContours>::set_own_spans() {
  const DF d;
  const DI di;
  if constexpr (kWithContours)
    for (int axis = 0; axis < 3; ++axis)
      for (std::size_t i = 0; i < rays_.size; i += kWidth) {
        const auto bits = hn::BitCast(di, hn::Load(d, rays_.origin[axis] + i));
        hn::Store(hn::Sub(bits, hn::Set(di, static_cast<std::int32_t>(kOne))), di,
                  position_[axis] + i);
        const auto speed =
            hn::Div(hn::Set(d, ContourRay::kDirectionOne), hn::Load(d, rays_.inverse[axis] + i));
        hn::Store(hn::ConvertTo(di, speed), di, direction_[axis] + i);
      }
  Spans& own = spans_[0];
  for (std::size_t i = 0; i < rays_.size; i += kWidth) {
    hn::Store(hn::Load(d, rays_.t_min + i), d, own.enter + i);
    hn::Store(hn::Load(d, rays_.t_end + i), d, own.leave + i);
    hn::Store(hn::Zero(di), di, own.enter_level + i);
  }
  own.first = t_range_[0];
  own.last = t_range_[1];
  span_at_[0] = 0;
}

template <bool kWithContours>
typename EsvoPacketWalk<kWithContours>::Rays EsvoPacketWalk<kWithContours>::clip(const Visit& visit,
                                                                                 Rays rays,
                                                                                 Rays& stopped) {
  const bool with_stop = static_cast<int>(visit.level) >= stop_level_;
  if (kWithContours && visit.contour.bits != 0)
    return with_stop ? clip<true, true>(visit, rays, stopped)
                     : clip<true, false>(visit, rays, stopped);
  return with_stop ? clip<false, true>(visit, rays, stopped)
                   : clip<false, false>(visit, rays, stopped);
}

/// The contour of the path's voxel of `level`, or an ancestor, by which a ray came to t, if by one.
template <bool kWithContours>
HWY_INLINE ContourPlane EsvoPacketWalk<kWithContours>::plane_at(std::uint32_t level,
                                                                std::size_t ray, float t) const {
  const Spans& spans = spans_below(level);
  const std::int32_t enter_level = spans.enter[ray] == t ? spans.enter_level[ray] : 0;
  return {enter_level != 0 ? contours_[enter_level] : Contour{}, enter_level};
}

template <bool kWithContours>
HWY_INLINE void EsvoPacketWalk<kWithContours>::record(const Visit& visit, Rays rays) {
  if (hits_ == nullptr) return;
  const Spans& spans = spans_below(visit.level);
  const int bit = 23 - static_cast<int>(visit.level);
  EsvoHits& hits = *hits_;
  std::uint32_t child = 0;
  for (int axis = 0; axis < 3; ++axis) child |= (visit.corner[axis] >> bit & 1u) << axis;
  for (; rays != 0; rays &= rays - 1) {
    const auto i = static_cast<std::size_t>(lowest_bit64(rays));
    float t = spans.enter[i];
    for (int axis = 0; axis < 3; ++axis) {
      hits.corner[axis][i] = visit.corner[axis];
      const float upper = float_from_bits(visit.corner[axis] + (1u << bit));
      const float enter = (rays_.origin[axis][i] - upper) * rays_.inverse[axis][i];
      t = enter > t ? enter : t;
    }
    hits.t[i] = t;
    hits.level[i] = static_cast<int>(visit.level);
    hits.slot[i] = slots_[visit.level - 1];
    hits.child[i] = static_cast<std::uint8_t>(child ^ rays_.mirrored);
    if constexpr (kWithContours) hits.plane[i] = plane_at(visit.level, i, t);
  }
}

template <bool kWithContours>
HWY_INLINE void EsvoPacketWalk<kWithContours>::push_children(const Visit& visit,
                                                             ChildDescriptor descriptor,
                                                             std::uint32_t met,
                                                             const ChildRays& children,
                                                             bool is_exact) {
  if (met == 0) return;
  const std::uint32_t half = 1u << (22 - visit.level);
  const std::uint32_t inner = descriptor.inner_mask();
  const std::uint32_t with_contour = kWithContours ? descriptor.contour_mask() : 0;
  const auto& inner_before = kBefore[inner];
  const auto& contours_before = kBefore[with_contour];
  const std::uint32_t* const contours = contours_of(visit, descriptor);
  const std::uint64_t first_child =
      inner != 0 ? esvo_.first_child(visit.slot, descriptor) : std::uint64_t{0};
  for (; met != 0; met &= met - 1) {
    const auto child = static_cast<std::uint32_t>(lowest_bit64(met));
    // Taken back where no ray meets the child: that is hard to foretell.
    Visit& next = stack_[top_];
    next.rays = children.meet[child];
    top_ += next.rays != 0 ? 1 : 0;
    const std::uint32_t index = child ^ rays_.mirrored;
    set_child_corner(visit.corner, child, half, next.corner);
    next.is_exact = is_exact;
    const bool is_inner = (inner >> index & 1u) != 0;
    next.slot = is_inner ? first_child + inner_before[index] : kLeaf;
    hwy::Prefetch(esvo_.slots + (is_inner ? next.slot : visit.slot));
    next.contour = {};
    if constexpr (kWithContours) {
      const std::uint32_t has_contour = with_contour >> index & 1u;
      next.contour.bits = contours[has_contour * contours_before[index]] & (0u - has_contour);
    }
  }
}

template <bool kWithContours>
typename EsvoPacketWalk<kWithContours>::Rays EsvoPacketWalk<kWithContours>::walk(Rays all) {
  Rays searching = all;
  stack_[0] = {{kOne, kOne, kOne}, 0, all, esvo_.root, {}, true};
  top_ = 1;
  while (top_ > 0 && searching != 0) {
    const Visit visit = stack_[--top_];
    const std::uint32_t level = visit.level;
    Rays rays = visit.rays & searching;
    if (rays == 0) continue;
    const bool is_cut = kWithContours && visit.contour.bits != 0;
    const bool is_leaf = visit.slot == kLeaf;
    bool is_exact = visit.is_exact;
    if (level > 0) {
      Rays stopped = 0;
      if (is_cut || static_cast<int>(level) >= stop_level_ || (is_leaf && !is_exact)) {
        rays = clip(visit, rays, stopped);
        if (rays == 0) continue;
      }
      if constexpr (kWithContours) {
        span_at_[level] = is_cut ? level : span_at_[level - 1];
        contours_[level] = visit.contour;
      }
      if (is_leaf) stopped = rays;
      if (stopped != 0) {
        record(visit, stopped);
        searching &= ~stopped;
        rays &= ~stopped;
        if (rays == 0) continue;
      }
    }
    slots_[level] = visit.slot;
    const ChildDescriptor descriptor = esvo_.descriptor(visit.slot);
    const std::uint32_t mask = mirrored(descriptor.valid_mask());
    const Spans& spans = spans_below(level);
    ChildRays children;
    const bool by_hull =
        are_many(rays) && are_narrow(visit.corner, static_cast<int>(level), spans.first);
    std::uint32_t met = mask;
    if (by_hull) {
      met &= children_met_by_hull(visit, spans);
      for (Rays& meet : children.meet) meet = rays;
    } else if (popcount64(rays) <= kFew) {
      searching &= ~end_at_children(visit, descriptor, rays, children);
    } else {
      intersect(visit, spans, rays, children);
    }
    push_children(visit, descriptor, met, children, !by_hull);
  }
  return all & ~searching;
}

template <bool kWithContours>
typename EsvoPacketWalk<kWithContours>::Rays EsvoPacketWalk<kWithContours>::cast(
    const RayPacket& packet) {
  if (packet.size == 0 || esvo_.is_empty()) return 0;
  load(packet);
  bound(kMaxLevels + 1);
  set_own_spans();
  return walk(first(packet.size));
}

template <class Nodes>
std::uint64_t cast_packet_simd(const Nodes& nodes, const RayPacket& packet, EsvoHits* hits) {
  return EsvoPacketWalk<std::is_same_v<Nodes, ContourNodes>>(nodes.view(), hits).cast(packet);
}

#else

template <class Nodes>
std::uint64_t cast_packet_simd(const Nodes& nodes, const RayPacket& packet, EsvoHits* hits) {
  return cast_one_by_one(nodes, packet, hits);
}

#endif

std::uint64_t cast_cube_packet(const EsvoNodes& nodes, const RayPacket& packet, EsvoHits* hits) {
  return cast_packet_simd(nodes, packet, hits);
}
std::uint64_t cast_contour_packet(const ContourNodes& nodes, const RayPacket& packet,
                                  EsvoHits* hits) {
  return cast_packet_simd(nodes, packet, hits);
}

}  // namespace HWY_NAMESPACE
}  // namespace voxdag
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace voxdag {

HWY_EXPORT(cast_cube_packet);
HWY_EXPORT(cast_contour_packet);

void cast_packet(const EsvoNodes& nodes, const RayPacket& packet, EsvoHits& hits) {
  hits.met = HWY_DYNAMIC_DISPATCH(cast_cube_packet)(nodes, packet, &hits);
}

void cast_packet(const ContourNodes& nodes, const RayPacket& packet, EsvoHits& hits) {
  hits.met = HWY_DYNAMIC_DISPATCH(cast_contour_packet)(nodes, packet, &hits);
}

std::uint64_t cast_packet_any(const EsvoNodes& nodes, const RayPacket& packet) {
  return HWY_DYNAMIC_DISPATCH(cast_cube_packet)(nodes, packet, nullptr);
}

std::uint64_t cast_packet_any(const ContourNodes& nodes, const RayPacket& packet) {
  return HWY_DYNAMIC_DISPATCH(cast_contour_packet)(nodes, packet, nullptr);
}

}  // namespace voxdag
#endif
