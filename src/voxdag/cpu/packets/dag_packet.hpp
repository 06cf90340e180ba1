#pragma once
/// Casts packets of rays at a DAG.
#include "voxdag/cpu/packets/bounded_dag.hpp"
#include "voxdag/cpu/packets/in_place_dag.hpp"
#include "voxdag/cpu/packets/ray_packet.hpp"

namespace voxdag {

template <>
struct PacketTarget<BoundedDag> {
  using Hits = PacketHits;
  static constexpr bool kByDirection = true;
};

template <>
struct PacketTarget<InPlaceDag> {
  using Hits = PacketHits;
  static constexpr bool kByDirection = true;
};

/// Casts the packet's rays. Each meets the cell that cast() in trace/cast.hpp finds for it, to the
/// bit, on any instruction set. The rays' levels of detail must have the same coarsest level.
void cast_packet(const BoundedDag& dag, const RayPacket& packet, PacketHits& hits);

/// Returns which of the rays meet anything, in the form of PacketHits::met.
std::uint64_t cast_packet_any(const BoundedDag& dag, const RayPacket& packet);

/// Casts the packet's rays at a compact DAG, with the results of the functions above. Uses the
/// calling thread's cache of units.
void cast_packet(const InPlaceDag& dag, const RayPacket& packet, PacketHits& hits);
std::uint64_t cast_packet_any(const InPlaceDag& dag, const RayPacket& packet);

}  // namespace voxdag
