// Casts up to 64 rays of like direction together. Compiled once for each instruction set; the best
// that the machine has is chosen at run time.
//
// The rays run down the same way along every axis once mirrored, so that all of them meet the
// children of a node in an order that the child index alone gives: one depth-first walk serves all,
// and a node is read once for all rays in it. In a node the nine planes of its children are met at
// nine T for each ray; the range of T in a child is what these leave. A ray is in a child at some T
// as grid_ray.hpp defines it just when that range is not empty, so each ray meets the cells that a
// cast of its own would meet, at the same T, to the bit. In a leaf block it is the other way round:
// the lanes are the voxels, and all 64 are tried for one ray.
//
// The walk starts at the lowest node that holds the starts of all rays, and climbs from there only
// as far as the rays reach.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "voxdag/cpu/cast_packet.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "voxdag/cpu/packet_bounds-inl.hpp"
#include "voxdag/cpu/packet_cells-inl.hpp"
#include "voxdag/cpu/packet_walk-inl.hpp"
#include "voxdag/cpu/ray_packet.hpp"

HWY_BEFORE_NAMESPACE();
namespace voxdag {
namespace HWY_NAMESPACE {

#if VOXDAG_PACKET_LANES

/// Puts the nodes to visit first on the stack; returns how many.
inline std::size_t PacketWalk::begin(Rays all, Visit* stack) const {
  CommonCell starts, reach;
  common_cells(starts, reach, packet_.has_stop ? finest_without_stop() : nodes_.levels() - 2);
  std::size_t top = 0;
  std::uint32_t node = nodes_.root();
  for (int level = 0;; ++level) {
    const std::uint32_t child_bit = 22u - static_cast<std::uint32_t>(level);
    const std::uint32_t index = (starts.corner[0] >> child_bit & 1u) |
                                (starts.corner[1] >> child_bit & 1u) << 1 |
                                (starts.corner[2] >> child_bit & 1u) << 2;
    const std::uint32_t unmirrored = nodes_.child_mask(node, level);
    const bool descends =
        level < starts.level && (unmirrored >> (index ^ packet_.mirrored) & 1u) != 0;
    if (level >= reach.level || !descends) {
      // Of the rays' own child's cell nothing is left above the node where they start.
      Visit& visit = stack[top++];
      visit.rays = all;
      visit.node = node;
      for (int axis = 0; axis < 3; ++axis)
        visit.corner[axis] = level == 0 ? kOne : starts.corner[axis] & ~0u << (child_bit + 1);
      visit.level = static_cast<std::uint32_t>(level);
      visit.skipped = descends ? 1u << index : 0u;
    }
    if (!descends) return top;
    node = nodes_.child(node, level, static_cast<int>(index ^ packet_.mirrored));
  }
}

template <bool kWithStop>
inline PacketWalk::Rays PacketWalk::walk(Rays all) {
  static constexpr MaskTable kMasks = mirrored_masks();
  const std::array<std::uint8_t, 256>& masks = kMasks[packet_.mirrored];
  const std::uint32_t mirrored = packet_.mirrored;
  const auto levels = static_cast<std::uint32_t>(nodes_.levels());
  Rays searching = all;
  Visit stack[8 * kMaxLevels];
  StopVisit stop_stack[kWithStop ? 8 * kMaxLevels : 1];
  std::size_t top = begin(all, stack);
  if constexpr (kWithStop)
    for (std::size_t i = 0; i < top; ++i) stop_stack[i] = {0, all};

  while (top > 0) {
    // Field by field, as it was stored: a wider load would wait for the stores. The corner and the
    // level were stored as one.
    const Visit& popped = stack[--top];
    Rays rays = popped.rays & searching;
    Visit visit;
    visit.node = popped.node;
    visit.skipped = popped.skipped;
    const hn::CappedTag<std::uint32_t, 4> d4;
    hn::StoreU(hn::LoadU(d4, popped.corner), d4, visit.corner);
    bool is_block = visit.level + 2 == levels;
    if constexpr (kWithStop) {
      const StopVisit stop = stop_stack[top];
      if (const Rays ended = stop.here & rays; ended != 0) {
        record(ended, visit.corner, static_cast<int>(visit.level));
        searching &= ~ended;
        rays &= ~ended;
      }
      is_block = is_block && (stop.finer & rays) == 0;
    }
    if (rays == 0) continue;
    if (is_block) {
      const std::uint64_t block = mirrored_block(nodes_.block(visit.node), mirrored);
      searching &= ~cast_in_block(block, visit.corner, static_cast<int>(levels), rays);
      if (searching == 0) break;
      continue;
    }

    const int level = static_cast<int>(visit.level);
    const std::uint32_t mask = masks[nodes_.child_mask(visit.node, level)] & ~visit.skipped;
    ChildRays children;
    std::uint32_t met;
    const std::uint32_t child_level = visit.level + 1;
    const bool with_stop =
        kWithStop && child_level >= static_cast<std::uint32_t>(stop_level_) && child_level < levels;
    if (!with_stop && (rays >> (2 * kWidth - 1) >> 1) != 0 && child_level < levels &&
        is_narrow(visit.corner, level)) {
      met = children_met_by_hull(visit.corner, level) & mask;
      for (Rays& meet : children.meet) meet = rays;
    } else {
      if (with_stop)
        intersect<true>(visit.corner, level, rays, children);
      else
        intersect<false>(visit.corner, level, rays, children);
      met = mask;
    }

    const std::uint32_t half = 1u << (22 - visit.level);
    if (kWithStop && child_level == levels) {
      while (met != 0) {
        const auto child = static_cast<std::uint32_t>(highest_bit(met));
        met ^= 1u << child;
        Visit voxel;
        set_child(voxel, visit, child, half);
        const Rays hits = children.meet[child] & searching;
        record(hits, voxel.corner, static_cast<int>(levels));
        searching &= ~hits;
      }
      if (searching == 0) break;
      continue;
    }
    for (; met != 0; met &= met - 1) {
      const auto child = static_cast<std::uint32_t>(__builtin_ctz(met));
      Visit& next = stack[top];
      next.rays = children.meet[child];
      next.node = nodes_.child(visit.node, level, static_cast<int>(child ^ mirrored));
      next.skipped = 0;
      hwy::Prefetch(static_cast<const std::uint32_t*>(nodes_.address(next.node, level + 1)));
      set_child(next, visit, child, half);
      if constexpr (kWithStop) {
        // Cells too coarse to be judged are not the last above voxels.
        stop_stack[top].here = with_stop ? children.stop[child] : 0;
        stop_stack[top].finer = with_stop ? children.finer[child] : next.rays;
      }
      top += next.rays != 0 ? 1 : 0;
    }
  }
  return all & ~searching;
}

inline PacketWalk::Rays PacketWalk::cast() {
  if (packet_.size == 0 || nodes_.is_empty()) return 0;
  pad();
  bound();
  const Rays all = packet_.size == RayPacket::kMaxRays ? ~Rays{0} : (Rays{1} << packet_.size) - 1;
  return packet_.has_stop && stop_level_ < nodes_.levels() ? walk<true>(all) : walk<false>(all);
}

std::uint64_t cast_packet_simd(const SvdagNodes& nodes, RayPacket& packet) {
  return PacketWalk(nodes, packet).cast();
}

#else

std::uint64_t cast_packet_simd(const SvdagNodes& nodes, RayPacket& packet) {
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
    CellHit hit;
    if (!voxdag::cast(nodes, ray, stop, hit)) continue;
    hits |= std::uint64_t{1} << i;
    packet.cell[i][0] = hit.x;
    packet.cell[i][1] = hit.y;
    packet.cell[i][2] = hit.z;
    packet.level[i] = hit.level;
  }
  return hits;
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace voxdag
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace voxdag {

HWY_EXPORT(cast_packet_simd);

std::uint64_t cast_packet(const SvdagNodes& nodes, RayPacket& packet) {
  return HWY_DYNAMIC_DISPATCH(cast_packet_simd)(nodes, packet);
}

}  // namespace voxdag
#endif
