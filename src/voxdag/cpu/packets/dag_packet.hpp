#pragma once
/// Rays of like direction that are cast at a DAG together.
#include "voxdag/cpu/packets/bounded_dag.hpp"
#include "voxdag/cpu/packets/ray_packet.hpp"

namespace voxdag {

template <>
struct PacketTarget<BoundedDag> {
  using Hits = PacketHits;
  static constexpr bool kByDirection = true;
};

/// Casts the packet's rays. What each meets is what cast() in trace/cast.hpp finds for it, to the
/// bit, on any instruction set. The rays' levels of detail must agree in the coarsest level.
void cast_packet(const BoundedDag& dag, const RayPacket& packet, PacketHits& hits);

/// Which of the rays meet anything, as PacketHits::met.
std::uint64_t cast_packet_any(const BoundedDag& dag, const RayPacket& packet);

}  // namespace voxdag
