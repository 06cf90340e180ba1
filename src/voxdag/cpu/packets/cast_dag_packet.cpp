// Casts up to 64 rays of like direction together. Compiled once for each instruction set; the best
// that the machine has is chosen at run time.
//
// The rays run down the same way along every axis once mirrored, so that all of them meet the
// children of a node in an order that the child index alone gives: one depth-first walk serves all,
// and a node is read once for all rays in it. A ray is in a cell, or in a box of whole voxels, at
// some T as grid_ray.hpp defines it just when the range of T that the planes leave is not empty, so
// each ray ends where a cast of its own would end, at the same T, to the bit.
//
// A child is visited only by rays that meet the box of its voxels (bounded_dag.hpp). The boxes of
// eight children are tried first for the ranges that the rays are in, then for the rays. In a leaf
// block the lanes are rays, or, where there are few, the voxels, and all 64 are tried for one ray.
//
// The walk starts at the lowest node that holds the starts of all rays, and climbs from there only
// as far as the rays reach.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "voxdag/cpu/packets/cast_dag_packet.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>

#include "voxdag/cpu/packets/dag_packet.hpp"
#include "voxdag/cpu/packets/dag_packet_blocks-inl.hpp"
#include "voxdag/cpu/packets/dag_packet_boxes-inl.hpp"
#include "voxdag/cpu/packets/dag_packet_starts-inl.hpp"
#include "voxdag/cpu/packets/dag_packet_walk-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace voxdag {
namespace HWY_NAMESPACE {

#if VOXDAG_PACKET_LANES

/// Puts the nodes to visit first on the stack; returns how many.
inline std::size_t DagPacketWalk::begin(Rays all, Visit* stack) const {
  CommonCell starts, reach;
  common_cells(starts, reach, rays_.has_stop ? finest_without_stop() : nodes_.levels() - 2);
  std::size_t top = 0;
  std::uint32_t node = nodes_.root();
  for (int level = 0;; ++level) {
    const std::uint32_t child_bit = 22u - static_cast<std::uint32_t>(level);
    const std::uint32_t index = (starts.corner[0] >> child_bit & 1u) |
                                (starts.corner[1] >> child_bit & 1u) << 1 |
                                (starts.corner[2] >> child_bit & 1u) << 2;
    const std::uint32_t unmirrored = nodes_.child_mask(node, level);
    const bool descends =
        level < starts.level && (unmirrored >> (index ^ rays_.mirrored) & 1u) != 0;
    if (level >= reach.level || !descends) {
      // Of the rays' own child's cell nothing is left above the node where they start.
      Visit& visit = stack[top++];
      visit.rays = all;
      visit.node = node;
      for (int axis = 0; axis < 3; ++axis)
        visit.corner[axis] = level == 0 ? kOne : starts.corner[axis] & ~0u << (child_bit + 1);
      visit.level = static_cast<std::uint32_t>(level);
      visit.skipped = descends ? 1u << index : stop_level_ < nodes_.levels() ? kOctantsMayEnd : 0u;
    }
    if (!descends) return top;
    node = nodes_.child(node, level, static_cast<int>(index ^ rays_.mirrored));
  }
}

inline void DagPacketWalk::walk() {
  Visit stack[16 * kMaxLevels];
  std::size_t top = begin(searching_, stack);
  while (top > 0) {
    // Field by field, as it was stored: a wider load would wait for the stores. The corner and the
    // level were stored as one.
    const Visit& popped = stack[--top];
    Visit visit;
    visit.rays = popped.rays & searching_;
    if (visit.rays == 0) continue;
    visit.node = popped.node;
    visit.skipped = popped.skipped;
    store(load(popped), visit);
    if (visit.skipped == kEndsHere)
      end(visit.rays, visit.corner, static_cast<int>(visit.level));
    else if (static_cast<int>(visit.level) == nodes_.levels() - 2)
      if ((visit.skipped & kOctantsEnd) != 0)
        end_at_octants(visit);
      else
        cast_in_block(visit);
    else
      visit_children(visit, stack, top);
    if (searching_ == 0) return;
  }
}

inline DagPacketWalk::Rays DagPacketWalk::cast(const RayPacket& packet) {
  if (packet.size == 0 || nodes_.is_empty()) return 0;
  load(packet);
  bound(nodes_.levels());
  const Rays all = first(packet.size);
  searching_ = all;
  walk();
  if (hits_ != nullptr) set_hit_t();
  return all & ~searching_;
}

std::uint64_t cast_dag_packet(const BoundedDag& dag, const RayPacket& packet, PacketHits* hits) {
  return DagPacketWalk(dag, hits).cast(packet);
}

#else

std::uint64_t cast_dag_packet(const BoundedDag& dag, const RayPacket& packet, PacketHits* hits) {
  return cast_one_by_one(dag.nodes(), packet, hits);
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace voxdag
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace voxdag {

HWY_EXPORT(cast_dag_packet);

void cast_packet(const BoundedDag& dag, const RayPacket& packet, PacketHits& hits) {
  hits.met = HWY_DYNAMIC_DISPATCH(cast_dag_packet)(dag, packet, &hits);
}

std::uint64_t cast_packet_any(const BoundedDag& dag, const RayPacket& packet) {
  return HWY_DYNAMIC_DISPATCH(cast_dag_packet)(dag, packet, nullptr);
}

}  // namespace voxdag
#endif
