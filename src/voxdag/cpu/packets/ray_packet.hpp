#pragma once
/// Rays of like direction that are cast together, and what they meet.
#include <cstddef>
#include <cstdint>

#include "voxdag/trace/scalar_caster.hpp"

namespace voxdag {

/// Up to 64 rays that are mirrored alike.
struct RayPacket {
  static constexpr std::size_t kMaxRays = 64;

  const CastRay* rays[kMaxRays];  ///< With misses() false.
  std::size_t size = 0;
};

/// What the rays of a packet met. Arrays are by ray, those of rays that met nothing undefined, but
/// levels are always those of a cell.
struct PacketHits {
  std::uint64_t met = 0;  ///< Bit i: ray i met a cell.
  alignas(64) float t[RayPacket::kMaxRays];
  std::uint32_t corner[3][RayPacket::kMaxRays];  ///< By axis: the float bits.
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

/// Casts the packet's rays one by one: for machines whose vectors are too small. Returns which meet
/// anything, bit i for ray i; `hits` may be null.
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

/// Of what packets are cast at: the type of its PacketHits, and whether rays of many neighbouring
/// points that run the same way make the better packet (true), or all rays of a few (false).
template <class Target>
struct PacketTarget {};

}  // namespace voxdag
