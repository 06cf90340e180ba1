// Casts packets of up to 64 rays at an ESVO. Compiled once for each instruction set; the best one
// that the machine has is chosen at run time.
//
// Source: packets of rays by I. Wald, P. Slusallek, C. Benthin and M. Wagner, "Interactive
// Rendering with Coherent Ray Tracing", Eurographics 2001; contours by S. Laine and T. Karras,
// "Efficient Sparse Voxel Octrees", I3D 2010, section 4.
//
// The idea: as in cast_dag_packet.cpp, mirrored rays run down along every axis. So one depth-first
// walk, nearest children first, serves all rays: it reads a descriptor, and decodes a contour, once
// for all rays in the voxel. A ray meets a voxel's shape exactly if a range of T remains after the
// cuts by the contours of the ancestors, the voxel's cube and its own contour. The walk of one ray
// in trace/esvo_cast.hpp computes the same ranges with the same products, so both agree to the bit.
//
// The walk tests a contour when it visits the voxel, not when it visits the parent: by then, rays
// that ended at nearer voxels are gone. For the voxel's level, it stores the ranges of T that
// remain after the contour, until it has visited all descendants. If many rays are close together,
// it tests them as one wide ray (the hull) against all children's cubes and contours before it
// visits the children. If only a few rays are left, it tests one ray after the other, each against
// all children and their contours at once.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "voxdag/cpu/packets/cast_esvo_packet.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "voxdag/cpu/packets/esvo_packet.hpp"
#include "voxdag/cpu/packets/esvo_packet_cells-inl.hpp"
#include "voxdag/cpu/packets/esvo_packet_children-inl.hpp"
#include "voxdag/cpu/packets/esvo_packet_hull-inl.hpp"
#include "voxdag/cpu/packets/esvo_packet_walk-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace voxdag {
namespace HWY_NAMESPACE {

#if VOXDAG_PACKET_LANES

/// Prepares the rays: sets spans_[0] to their own ranges, and positions and directions to
/// ContourRay's.
template <bool kWithContours, bool kOneOrigin>
void EsvoPacketWalk<kWithContours, kOneOrigin>::prepare_rays() {
  const DF d;
  const DI di;
  for (int axis = 0; axis < 3; ++axis)
    sign_[axis] = -static_cast<std::int32_t>(rays_.mirrored >> axis & 1u);
  if constexpr (kWithContours)
    for (int axis = 0; axis < 3; ++axis) {
      for (std::size_t i = 0; i < rays_.size; i += kWidth) {
        const auto bits = hn::BitCast(di, hn::Load(d, rays_.origin[axis] + i));
        hn::Store(hn::Sub(bits, hn::Set(di, static_cast<std::int32_t>(kOne))), di,
                  position_[axis] + i);
        const auto speed =
            hn::Div(hn::Set(d, ContourRay::kDirectionOne), hn::Load(d, rays_.inverse[axis] + i));
        hn::Store(hn::ConvertTo(di, speed), di, direction_[axis] + i);
      }
      // Ranges can be converted by their ends, because both conversions are monotone.
      const auto position = [](float p) {
        return static_cast<std::int32_t>(bits_of_float(p) - kOne);
      };
      position_range_[axis][0] = position(origins_.least[axis]);
      position_range_[axis][1] = position(origins_.most[axis]);
      direction_range_[axis][0] = ContourRay::direction(inverses_.most[axis]);
      direction_range_[axis][1] = ContourRay::direction(inverses_.least[axis]);
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

template <bool kWithContours, bool kOneOrigin>
typename EsvoPacketWalk<kWithContours, kOneOrigin>::Rays
EsvoPacketWalk<kWithContours, kOneOrigin>::clip(const Visit& visit, Rays rays, Rays& stopped) {
  const bool with_stop = (visit.known & kMayStop) != 0;
  if constexpr (kWithContours)
    if ((visit.known & kHasContour) != 0)
      return with_stop ? clip<true, true>(visit, rays, stopped)
                       : clip<true, false>(visit, rays, stopped);
  return with_stop ? clip<false, true>(visit, rays, stopped)
                   : clip<false, false>(visit, rays, stopped);
}

/// Returns the contour that a ray crosses at t (of the visited voxel or an ancestor), if there is
/// one.
template <bool kWithContours, bool kOneOrigin>
HWY_INLINE ContourPlane EsvoPacketWalk<kWithContours, kOneOrigin>::plane_at(const Visit& visit,
                                                                            std::size_t ray,
                                                                            float t) const {
  const Spans& spans = spans_below(visit.level);
  const std::int32_t level = spans.enter[ray] == t ? spans.enter_level[ray] : 0;
  if (level == 0) return {};
  const std::uint32_t child = child_of(visit.corner, static_cast<std::uint32_t>(level));
  return {Contour{static_cast<std::uint32_t>(child_contours_[level - 1].words[child])}, level};
}

template <bool kWithContours, bool kOneOrigin>
HWY_INLINE void EsvoPacketWalk<kWithContours, kOneOrigin>::record(const Visit& visit, Rays rays) {
  if (hits_ == nullptr) return;
  const Spans& spans = spans_below(visit.level);
  const int bit = 23 - static_cast<int>(visit.level);
  EsvoHits& hits = *hits_;
  const auto child = static_cast<std::uint8_t>(child_of(visit.corner, visit.level));
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
    hits.child[i] = child;
    if constexpr (kWithContours) hits.plane[i] = plane_at(visit, i, t);
  }
}

template <bool kWithContours, bool kOneOrigin>
HWY_INLINE void EsvoPacketWalk<kWithContours, kOneOrigin>::push_children(const Visit& visit,
                                                                         ChildDescriptor descriptor,
                                                                         const ChildRays& children,
                                                                         std::uint32_t known) {
  std::uint32_t met = children.met;
  if (met == 0) return;
  const std::uint32_t inner = descriptor.inner_mask();
  const std::uint32_t with_contour = kWithContours ? descriptor.contour_mask() : 0;
  const auto& inner_before = kBefore[inner];
  const std::uint64_t first_child =
      inner != 0 ? esvo_.first_child(visit.slot, descriptor) : std::uint64_t{0};
  for (; met != 0; met &= met - 1) {
    const auto child = static_cast<std::uint32_t>(lowest_bit64(met));
    Visit& next = stack_[top_++];
    next.rays = children.meet[child];
    const std::uint32_t index = child ^ rays_.mirrored;
    set_child(visit, child, next);
    next.known = known | ((with_contour >> index & 1u) != 0 ? kHasContour : 0);
    const bool is_inner = (inner >> index & 1u) != 0;
    next.slot = is_inner ? first_child + inner_before[index] : kLeaf;
    hwy::Prefetch(esvo_.slots + (is_inner ? next.slot : visit.slot));
  }
}

/// Returns whether the level of detail may end any ray at a child of the voxel.
template <bool kWithContours, bool kOneOrigin>
HWY_INLINE bool EsvoPacketWalk<kWithContours, kOneOrigin>::may_stop_below(
    const Visit& visit) const {
  const auto level = static_cast<int>(visit.level) + 1;
  if (level < stop_level_) return false;
  return side_of(level) <= stop_start_[1] + stop_per_t_[1] * last_exit(visit);
}

/// Tests the children of a voxel. Returns the rays that end at a child. Pushes the children that
/// other rays meet onto the stack, the nearest on top.
template <bool kWithContours, bool kOneOrigin>
HWY_INLINE typename EsvoPacketWalk<kWithContours, kOneOrigin>::Rays
EsvoPacketWalk<kWithContours, kOneOrigin>::visit_children(const Visit& visit, Rays rays) {
  slots_[visit.level] = visit.slot;
  const ChildDescriptor descriptor = esvo_.descriptor(visit.slot);
  const Spans& spans = spans_below(visit.level);
  const bool may_stop = may_stop_below(visit);
  ChildRays children;
  children.met = mirrored(descriptor.valid_mask());
  std::uint32_t known = may_stop ? kMayStop : 0;
  const std::uint32_t with_contour = kWithContours ? descriptor.contour_mask() : 0;
  const bool are_few = popcount64(rays) <= kFew;
  ChildCubes cubes;
  if (with_contour != 0 || are_few) set_child_cubes(visit, cubes);
  if (with_contour != 0) set_child_contours(visit, descriptor, cubes);
  Rays ended = 0;
  if (are_few) {
    ended = end_at_children(visit, descriptor, cubes, rays, may_stop, children);
    known |= kMeetCube | kMeetShape;
  } else if (are_many(rays) && are_narrow(visit, spans.first)) {
    children.met &= with_contour != 0 ? shapes_met_by_hull(visit, with_contour, cubes, spans)
                                      : cubes_met_by_hull(visit, spans);
    for (Rays& meet : children.meet) meet = rays;
  } else {
    intersect(visit, spans, rays, children);
    known |= kMeetCube;
  }
  push_children(visit, descriptor, children, known);
  return ended;
}

template <bool kWithContours, bool kOneOrigin>
typename EsvoPacketWalk<kWithContours, kOneOrigin>::Rays
EsvoPacketWalk<kWithContours, kOneOrigin>::walk(Rays all) {
  Rays searching = all;
  stack_[0] = {{{kOne, kOne, kOne}, 0}, all, esvo_.root, kMeetCube};
  top_ = 1;
  while (top_ > 0 && searching != 0) {
    // Loads the fields separately, as they were stored, because a wider load would wait for the
    // stores. The corner and the level were stored as one vector.
    const Visit& popped = stack_[--top_];
    Rays rays = popped.rays & searching;
    if (rays == 0) continue;
    Visit visit;
    visit.rays = rays;
    store(load(popped), visit);
    visit.slot = popped.slot;
    visit.known = popped.known;
    const std::uint32_t level = visit.level;
    const bool is_cut = kWithContours && (visit.known & kHasContour) != 0;
    const bool is_leaf = visit.slot == kLeaf;
    if (level > 0) {
      Rays stopped = 0;
      const bool may_stop = (visit.known & kMayStop) != 0;
      if (is_cut && !may_stop && (visit.known & kMeetShape) != 0) {
        if constexpr (kWithContours) recall_spans(visit, rays);
      } else if (is_cut || may_stop || (is_leaf && (visit.known & kMeetCube) == 0)) {
        rays = clip(visit, rays, stopped);
        if (rays == 0) continue;
      }
      if constexpr (kWithContours) {
        span_at_[level] = is_cut ? level : span_at_[level - 1];
      }
      if (is_leaf) stopped = rays;
      if (stopped != 0) {
        record(visit, stopped);
        searching &= ~stopped;
        rays &= ~stopped;
        if (rays == 0) continue;
      }
    }
    searching &= ~visit_children(visit, rays);
  }
  return all & ~searching;
}

template <bool kWithContours, bool kOneOrigin>
typename EsvoPacketWalk<kWithContours, kOneOrigin>::Rays
EsvoPacketWalk<kWithContours, kOneOrigin>::cast(const RayPacket& packet) {
  load(packet);
  bound(kMaxLevels + 1);
  prepare_rays();
  return walk(first(packet.size));
}

template <class Nodes>
std::uint64_t cast_packet_simd(const Nodes& nodes, const RayPacket& packet, EsvoHits* hits) {
  constexpr bool kWithContours = std::is_same_v<Nodes, ContourNodes>;
  const EsvoView& esvo = nodes.view();
  if (packet.size == 0 || esvo.is_empty()) return 0;
  if (have_one_origin(packet)) return EsvoPacketWalk<kWithContours, true>(esvo, hits).cast(packet);
  return EsvoPacketWalk<kWithContours, false>(esvo, hits).cast(packet);
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
