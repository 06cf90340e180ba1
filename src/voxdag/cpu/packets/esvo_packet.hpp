#pragma once
/// Casts packets of rays at an ESVO.
#include "voxdag/cpu/packets/ray_packet.hpp"
#include "voxdag/trace/esvo_cast.hpp"

namespace voxdag {

/// PacketHits with the additional fields of EsvoHit.
struct EsvoHits : PacketHits {
  std::uint64_t slot[RayPacket::kMaxRays];  ///< EsvoVoxel::slot.
  std::uint8_t child[RayPacket::kMaxRays];  ///< EsvoVoxel::child.
  ContourPlane plane[RayPacket::kMaxRays];  ///< EsvoHit::plane.

  EsvoHit operator[](std::size_t i) const {
    EsvoHit hit;
    static_cast<CellHit&>(hit) = PacketHits::operator[](i);
    hit.voxel = {slot[i], child[i]};
    hit.plane = plane[i];
    return hit;
  }
  void set(std::size_t i, const EsvoHit& hit) {
    PacketHits::set(i, hit);
    slot[i] = hit.voxel.slot;
    child[i] = static_cast<std::uint8_t>(hit.voxel.child);
    plane[i] = hit.plane;
  }
};

template <EsvoLayout Nodes>
struct PacketTarget<Nodes> {
  using Hits = EsvoHits;
  static constexpr bool kByDirection = false;
};

/// Casts the packet's rays. Each meets the voxel that cast() in trace/esvo_cast.hpp finds for it,
/// to the bit, on any instruction set. The rays' levels of detail must have the same coarsest
/// level.
void cast_packet(const EsvoNodes& nodes, const RayPacket& packet, EsvoHits& hits);
void cast_packet(const ContourNodes& nodes, const RayPacket& packet, EsvoHits& hits);

/// Returns which of the rays meet anything, in the form of PacketHits::met.
std::uint64_t cast_packet_any(const EsvoNodes& nodes, const RayPacket& packet);
std::uint64_t cast_packet_any(const ContourNodes& nodes, const RayPacket& packet);

}  // namespace voxdag
