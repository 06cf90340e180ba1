// Casts packets of up to 64 rays at a DAG. Compiled once for each instruction set; the best one
// that the machine has is chosen at run time.
//
// Source: packets of rays by I. Wald, P. Slusallek, C. Benthin and M. Wagner, "Interactive
// Rendering with Coherent Ray Tracing", Eurographics 2001; the plane and voxel rules of
// trace/grid_ray.hpp after S. Laine and T. Karras, "Efficient Sparse Voxel Octrees", I3D 2010.
//
// The idea: after mirroring, all rays of a packet run down along every axis. So they meet the
// children of a node in the order of the mirrored child index. One depth-first walk serves all
// rays, and reads a node once for all rays in it. By the definition in grid_ray.hpp, a ray is in a
// cell, or in a box of whole voxels, exactly if the range of T between its planes is not empty. So
// each ray ends at the cell and the T of a separate cast, to the bit.
//
// Only rays that meet the box of a child's voxels (bounded_dag.hpp) visit the child. The walk tests
// the boxes of all eight children first against the bounds on all rays, then against the rays. In a
// leaf block the lanes are rays; if there are few rays, the lanes are voxels.
//
// The walk starts at the finest node that holds the starts of all rays, and ascends from there only
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
#include "voxdag/cpu/packets/in_place_nodes.hpp"

HWY_BEFORE_NAMESPACE();
namespace voxdag {
namespace HWY_NAMESPACE {

#if VOXDAG_PACKET_LANES

/// Pushes the nodes to visit first onto the stack. Returns their number.
inline std::size_t DagPacketWalk::begin(Rays all, Visit* stack) {
  CommonCell starts, reach;
  common_cells(starts, reach, rays_.has_stop ? finest_without_stop() : levels_ - 2);
  std::size_t top = 0;
  std::uint32_t node = 0;
  for (int level = 0;; ++level) {
    const std::uint32_t child_bit = 22u - static_cast<std::uint32_t>(level);
    const std::uint32_t index = (starts.corner[0] >> child_bit & 1u) |
                                (starts.corner[1] >> child_bit & 1u) << 1 |
                                (starts.corner[2] >> child_bit & 1u) << 2;
    const std::uint32_t stored = index ^ rays_.mirrored;
    const std::uint32_t unit = node;
    if (level == unit_level_) {
      open_unit(unit);
      node = 0;
    }
    const std::uint32_t* words = nullptr;
    bool descends = level < starts.level;
    if (descends) {
      words = words_of(node, level);
      descends = (words[0] >> stored & 1u) != 0;
    }
    if (level >= reach.level || !descends) {
      // Skips the child in which the rays start, because another visit covers it.
      Visit& visit = stack[top++];
      visit.rays = all;
      visit.node = level == unit_level_ ? unit : node;
      for (int axis = 0; axis < 3; ++axis)
        visit.corner[axis] = level == 0 ? kOne : starts.corner[axis] & ~0u << (child_bit + 1);
      visit.level = static_cast<std::uint32_t>(level);
      visit.skipped = descends ? 1u << index : stop_level_ < levels_ ? kOctantsMayEnd : 0u;
    }
    if (!descends) return top;
    node = bounded_node_child(words, stored);
  }
}

inline void DagPacketWalk::walk() {
  Visit stack[16 * kMaxLevels];
  std::size_t top = begin(searching_, stack);
  while (top > 0) {
    // Loads the fields separately, as they were stored, because a wider load would wait for the
    // stores. The corner and the level were stored as one vector.
    const Visit& popped = stack[--top];
    Visit visit;
    visit.rays = popped.rays & searching_;
    if (visit.rays == 0) continue;
    visit.node = popped.node;
    visit.skipped = popped.skipped;
    store(load(popped), visit);
    if (visit.skipped == kEndsHere)
      end(visit.rays, visit.corner, static_cast<int>(visit.level));
    else if (static_cast<int>(visit.level) == levels_ - 2)
      if ((visit.skipped & kOctantsEnd) != 0)
        end_at_octants(visit);
      else
        cast_in_block(visit);
    else {
      if (static_cast<int>(visit.level) == unit_level_) {
        open_unit(visit.node);
        visit.node = 0;
      }
      visit_children(visit, stack, top);
    }
    if (searching_ == 0) return;
  }
}

inline DagPacketWalk::Rays DagPacketWalk::cast(const RayPacket& packet) {
  if (packet.size == 0 || is_empty_) return 0;
  load(packet);
  bound(levels_);
  const Rays all = first(packet.size);
  searching_ = all;
  walk();
  if (hits_ != nullptr) set_hit_t();
  return all & ~searching_;
}

std::uint64_t cast_dag_packet(const BoundedDag& dag, const RayPacket& packet, PacketHits* hits) {
  return DagPacketWalk(dag, hits).cast(packet);
}

std::uint64_t cast_in_place_packet(const InPlaceDag& dag, UnitCache& units, const RayPacket& packet,
                                   PacketHits* hits) {
  return DagPacketWalk(dag, units, hits).cast(packet);
}

#else

std::uint64_t cast_dag_packet(const BoundedDag& dag, const RayPacket& packet, PacketHits* hits) {
  return cast_one_by_one(dag.nodes(), packet, hits);
}

std::uint64_t cast_in_place_packet(const InPlaceDag& dag, UnitCache& units, const RayPacket& packet,
                                   PacketHits* hits) {
  return cast_one_by_one(InPlaceNodes(dag, units), packet, hits);
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace voxdag
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace voxdag {

HWY_EXPORT(cast_dag_packet);
HWY_EXPORT(cast_in_place_packet);

void cast_packet(const BoundedDag& dag, const RayPacket& packet, PacketHits& hits) {
  hits.met = HWY_DYNAMIC_DISPATCH(cast_dag_packet)(dag, packet, &hits);
}

std::uint64_t cast_packet_any(const BoundedDag& dag, const RayPacket& packet) {
  return HWY_DYNAMIC_DISPATCH(cast_dag_packet)(dag, packet, nullptr);
}

void cast_packet(const InPlaceDag& dag, const RayPacket& packet, PacketHits& hits) {
  hits.met = HWY_DYNAMIC_DISPATCH(cast_in_place_packet)(dag, dag.cache(), packet, &hits);
}

std::uint64_t cast_packet_any(const InPlaceDag& dag, const RayPacket& packet) {
  return HWY_DYNAMIC_DISPATCH(cast_in_place_packet)(dag, dag.cache(), packet, nullptr);
}

}  // namespace voxdag
#endif
