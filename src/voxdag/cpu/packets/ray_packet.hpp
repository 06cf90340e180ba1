#pragma once
/// Packets of rays of similar direction, and their hits.
#include <cstddef>
#include <cstdint>

#include "voxdag/trace/scalar_caster.hpp"

namespace voxdag {

/// Up to 64 rays with the same GridRay::mirrored.
struct RayPacket {
  static constexpr std::size_t kMaxRays = 64;

  const CastRay* rays[kMaxRays];  ///< None of them misses().
  std::size_t size = 0;
};

/// The hits of a packet. Arrays are indexed by ray. Values of rays that met nothing are undefined,
/// but `level` is always a valid level.
struct PacketHits {
  std::uint64_t met = 0;  ///< Bit i: ray i met a cell.
  alignas(64) float t[RayPacket::kMaxRays];
  std::uint32_t corner[3][RayPacket::kMaxRays];  ///< By axis, then by ray: float bits.
  int level[RayPacket::kMaxRays] = {};

  bool is_hit(std::size_t i) const { return (met >> i & 1u) != 0; }
  CellHit operator[](std::size_t i) const {
    return {t[i], corner[0][i], corner[1][i], corner[2][i], level[i]};
  }
  void set(std::size_t i, const CellHit& hit) {
    met |= std::uint64_t{1} << i;
    t[i] = hit.t;
    corner[0][i] = hit.x;
    corner[1][i] = hit.y;
    corner[2][i] = hit.z;
    level[i] = hit.level;
  }
};

/// Casts the packet's rays one at a time, for machines with small vectors. Returns which rays meet
/// anything, in the form of PacketHits::met; `hits` may be null.
template <class Nodes, class Hits>
std::uint64_t cast_one_by_one(const Nodes& nodes, const RayPacket& packet, Hits* hits) {
  std::uint64_t met = 0;
  for (std::size_t i = 0; i < packet.size; ++i) {
    typename FoundBy<Nodes>::Type hit;
    if (!cast(nodes, packet.rays[i]->ray, packet.rays[i]->stop, hit)) continue;
    met |= std::uint64_t{1} << i;
    if (hits != nullptr) hits->set(i, hit);
  }
  return met;
}

/// Traits of a target of packets. Hits is its type of PacketHits. kByDirection says which packets
/// of incoherent rays are faster: rays of similar direction from many neighbouring points (true),
/// or all rays of a few points (false).
template <class Target>
struct PacketTarget {};

}  // namespace voxdag
