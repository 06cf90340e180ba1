// Casts up to 64 rays of like direction at an ESVO together. Compiled once for each instruction
// set; the best that the machine has is chosen at run time.
//
// As in cast_packet.cpp the rays run down the same way along every axis once mirrored, so that one
// depth-first walk, nearest children first, serves all of them: a descriptor is read, and a contour
// decoded, once for all rays in the voxel. A ray meets a voxel's shape just when the range of T
// that the contours of its ancestors, its cube and its own contour leave is not empty; that is what
// the walk of one ray in trace/esvo_cast.hpp finds, to the bit, whose products these are.
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

#if VOXDAG_ESVO_PACKET_LANES

/// Fills the last vector with copies of the last ray.
template <bool kWithContours>
void EsvoPacketWalk<kWithContours>::pad() {
  for (std::size_t i = packet_.size; i % kWidth != 0; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      packet_.origin[axis][i] = packet_.origin[axis][packet_.size - 1];
      packet_.inverse[axis][i] = packet_.inverse[axis][packet_.size - 1];
    }
    packet_.t_min[i] = packet_.t_min[packet_.size - 1];
    packet_.t_end[i] = packet_.t_end[packet_.size - 1];
    packet_.stop_start[i] = packet_.stop_per_t[i] = 0;
  }
}

/// Sets what is known of the rays before the walk: the ranges that they are in.
template <bool kWithContours>
void EsvoPacketWalk<kWithContours>::bound() {
  const DF d;
  const DI di;
  const auto range = [&](const float* values, float out[2]) HWY_ATTR {
    auto low = hn::Load(d, values), high = low;
    for (std::size_t i = kWidth; i < packet_.size; i += kWidth) {
      low = hn::Min(low, hn::Load(d, values + i));
      high = hn::Max(high, hn::Load(d, values + i));
    }
    out[0] = hn::GetLane(hn::MinOfLanes(d, low));
    out[1] = hn::GetLane(hn::MaxOfLanes(d, high));
  };
  width_at_start_ = width_per_t_ = 0;
  for (int axis = 0; axis < 3; ++axis) {
    range(packet_.origin[axis], origin_range_[axis]);
    range(packet_.inverse[axis], inverse_range_[axis]);
    const float apart = origin_range_[axis][1] - origin_range_[axis][0];
    const float spread = 1 / inverse_range_[axis][0] - 1 / inverse_range_[axis][1];
    width_at_start_ = apart > width_at_start_ ? apart : width_at_start_;
    width_per_t_ = spread > width_per_t_ ? spread : width_per_t_;
    if constexpr (kWithContours)
      for (std::size_t i = 0; i < packet_.size; i += kWidth) {
        const auto bits = hn::BitCast(di, hn::Load(d, packet_.origin[axis] + i));
        hn::Store(hn::Sub(bits, hn::Set(di, static_cast<std::int32_t>(kOne))), di,
                  position_[axis] + i);
        const auto speed =
            hn::Div(hn::Set(d, ContourRay::kDirectionOne), hn::Load(d, packet_.inverse[axis] + i));
        hn::Store(hn::ConvertTo(di, speed), di, direction_[axis] + i);
      }
  }
  Spans& own = spans_[0];
  for (std::size_t i = 0; i < packet_.size; i += kWidth) {
    hn::Store(hn::Load(d, packet_.t_min + i), d, own.enter + i);
    hn::Store(hn::Load(d, packet_.t_end + i), d, own.leave + i);
    hn::Store(hn::Zero(di), di, own.enter_level + i);
  }
  float least[2], most[2];
  range(packet_.t_min, least);
  range(packet_.t_end, most);
  own.first = least[0];
  own.last = most[1];
  span_at_[0] = 0;
  stop_level_ = kMaxLevels + 1;
  if (!packet_.has_stop) return;
  range(packet_.stop_start, least);
  range(packet_.stop_per_t, most);
  // T is at most 1 in the grid.
  const float limit = (least[1] + most[1]) * (1 + 0x1p-10f);
  stop_level_ = static_cast<std::uint32_t>(packet_.coarsest);
  while (stop_level_ <= kMaxLevels && side_of(stop_level_) > limit) ++stop_level_;
}

template <bool kWithContours>
typename EsvoPacketWalk<kWithContours>::Rays EsvoPacketWalk<kWithContours>::clip(const Visit& visit,
                                                                                 Rays rays,
                                                                                 Rays& stopped) {
  const bool with_stop = visit.level >= stop_level_;
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
  const Spans& spans = spans_below(visit.level);
  const std::uint32_t size = 1u << (23 - visit.level);
  for (; rays != 0; rays &= rays - 1) {
    const auto i = static_cast<std::size_t>(lowest_bit64(rays));
    float t = spans.enter[i];
    for (int axis = 0; axis < 3; ++axis) {
      packet_.cell[i][axis] = visit.corner[axis];
      const float upper = float_from_bits(visit.corner[axis] + size);
      const float enter = (packet_.origin[axis][i] - upper) * packet_.inverse[axis][i];
      t = enter > t ? enter : t;
    }
    packet_.t[i] = t;
    packet_.level[i] = static_cast<int>(visit.level);
    packet_.slot[i] = slots_[visit.level - 1];
    if constexpr (kWithContours) packet_.plane[i] = plane_at(visit.level, i, t);
  }
}

template <bool kWithContours>
HWY_INLINE void EsvoPacketWalk<kWithContours>::push_children(const Visit& visit,
                                                             ChildDescriptor descriptor,
                                                             std::uint32_t met,
                                                             const ChildRays& children,
                                                             bool is_exact) {
  // By the child's bits: whether half is added to the corner; and to the level after that.
  alignas(16) static constexpr std::uint32_t kBits[8][4] = {
      {0, 0, 0, 0},   {~0u, 0, 0, 0},   {0, ~0u, 0, 0},   {~0u, ~0u, 0, 0},
      {0, 0, ~0u, 0}, {~0u, 0, ~0u, 0}, {0, ~0u, ~0u, 0}, {~0u, ~0u, ~0u, 0}};
  alignas(16) static constexpr std::uint32_t kNextLevel[4] = {0, 0, 0, 1};
  if (met == 0) return;
  const hn::CappedTag<std::uint32_t, 4> d4;
  const auto half = hn::Set(d4, 1u << (22 - visit.level));
  const auto corner = hn::Add(hn::LoadU(d4, visit.corner), hn::Load(d4, kNextLevel));
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
    const std::uint32_t index = child ^ packet_.mirrored;
    hn::StoreU(hn::Or(corner, hn::And(hn::Load(d4, kBits[child]), half)), d4, next.corner);
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
      if (is_cut || level >= stop_level_ || (is_leaf && !is_exact)) {
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
    const bool by_hull = may_go_by_hull(rays) && is_narrow(visit, spans);
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
typename EsvoPacketWalk<kWithContours>::Rays EsvoPacketWalk<kWithContours>::cast() {
  if (packet_.size == 0 || esvo_.is_empty()) return 0;
  pad();
  bound();
  return walk(packet_.size == RayPacket::kMaxRays ? ~Rays{0} : (Rays{1} << packet_.size) - 1);
}

template <bool kWithContours>
std::uint64_t cast_packet_simd(const EsvoView& esvo, EsvoPacket& packet) {
  return EsvoPacketWalk<kWithContours>(esvo, packet).cast();
}

#else

template <bool kWithContours>
std::uint64_t cast_packet_simd(const EsvoView& esvo, EsvoPacket& packet) {
  std::uint64_t hits = 0;
  for (std::size_t i = 0; i < packet.size; ++i) {
    GridRay ray;
    for (int axis = 0; axis < 3; ++axis) {
      ray.origin[axis] = packet.origin[axis][i];
      ray.inverse[axis] = packet.inverse[axis][i];
    }
    ray.t_min = packet.t_min[i];
    ray.t_max = packet.t_end[i] < HUGE_VALF ? float_from_bits(bits_of_float(packet.t_end[i]) - 1)
                                            : packet.t_end[i];
    ray.mirrored = packet.mirrored;
    const StopBelowSize stop{packet.stop_start[i], packet.stop_per_t[i], packet.coarsest};
    EsvoHit hit;
    using Nodes = std::conditional_t<kWithContours, ContourNodes, EsvoNodes>;
    if (!voxdag::cast(Nodes(esvo), ray, stop, hit)) continue;
    hits |= std::uint64_t{1} << i;
    packet.cell[i][0] = hit.x;
    packet.cell[i][1] = hit.y;
    packet.cell[i][2] = hit.z;
    packet.level[i] = hit.level;
    packet.t[i] = hit.t;
    packet.slot[i] = hit.voxel.slot;
    packet.plane[i] = hit.plane;
  }
  return hits;
}

#endif

std::uint64_t cast_cube_packet(const EsvoView& esvo, EsvoPacket& packet) {
  return cast_packet_simd<false>(esvo, packet);
}
std::uint64_t cast_contour_packet(const EsvoView& esvo, EsvoPacket& packet) {
  return cast_packet_simd<true>(esvo, packet);
}

}  // namespace HWY_NAMESPACE
}  // namespace voxdag
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace voxdag {

HWY_EXPORT(cast_cube_packet);
HWY_EXPORT(cast_contour_packet);

std::uint64_t cast_packet(const EsvoNodes& nodes, EsvoPacket& packet) {
  return HWY_DYNAMIC_DISPATCH(cast_cube_packet)(nodes.view(), packet);
}

std::uint64_t cast_packet(const ContourNodes& nodes, EsvoPacket& packet) {
  return HWY_DYNAMIC_DISPATCH(cast_contour_packet)(nodes.view(), packet);
}

}  // namespace voxdag
#endif
