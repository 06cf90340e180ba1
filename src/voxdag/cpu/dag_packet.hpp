#pragma once
/// Rays of like direction that are cast at a DAG together.
#include <cstddef>
#include <cstdint>

#include "voxdag/cpu/bounded_dag.hpp"
#include "voxdag/trace/scalar_caster.hpp"

namespace voxdag {

/// Up to 64 rays that are mirrored alike.
struct DagPacket {
  static constexpr std::size_t kMaxRays = 64;

  const CastRay* rays[kMaxRays];  ///< With misses() false.
  std::size_t size = 0;
};

/// What the rays of a packet met. Arrays are by ray, those of rays that met nothing undefined.
struct DagHits {
  std::uint64_t met = 0;  ///< Bit i: ray i met a cell.
  alignas(64) float t[DagPacket::kMaxRays];
  std::uint32_t corner[3][DagPacket::kMaxRays];  ///< By axis: the float bits.
  int level[DagPacket::kMaxRays];

  bool is_hit(std::size_t i) const { return (met >> i & 1u) != 0; }
  CellHit operator[](std::size_t i) const {
    return {t[i], corner[0][i], corner[1][i], corner[2][i], level[i]};
  }
};

/// Casts the packet's rays. What each meets is what cast() in trace/cast.hpp finds for it, to the
/// bit, on any instruction set. The rays' levels of detail must agree in the coarsest level.
void cast_packet(const BoundedDag& dag, const DagPacket& packet, DagHits& hits);

/// Which of the rays meet anything, as DagHits::met.
std::uint64_t cast_packet_any(const BoundedDag& dag, const DagPacket& packet);

}  // namespace voxdag
