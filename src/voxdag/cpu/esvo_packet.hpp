#pragma once
/// Rays of like direction that are cast at an ESVO together.
#include "voxdag/cpu/ray_packet.hpp"
#include "voxdag/trace/esvo_cast.hpp"

namespace voxdag {

/// A RayPacket, and what of an EsvoHit is more than a cell.
struct EsvoPacket : RayPacket {
  float t[kMaxRays];             ///< Of rays that met a shape: where they enter it.
  std::uint64_t slot[kMaxRays];  ///< Likewise the voxel's EsvoVoxel::slot,
  ContourPlane plane[kMaxRays];  ///< and EsvoHit::plane.

  /// What ray i, which met a shape, met first.
  EsvoHit hit(std::size_t i) const {
    EsvoHit hit;
    static_cast<CellHit&>(hit) = {t[i], cell[i][0], cell[i][1], cell[i][2], level[i]};
    const int bit = 23 - level[i];
    const std::uint32_t child =
        (cell[i][0] >> bit & 1u) | (cell[i][1] >> bit & 1u) << 1 | (cell[i][2] >> bit & 1u) << 2;
    hit.voxel = {slot[i], static_cast<int>(child ^ mirrored)};
    hit.plane = plane[i];
    return hit;
  }
};

/// Casts the packet's rays: sets what is said above of those that meet a shape, and returns them,
/// bit i for ray i. What each meets is what cast() in trace/esvo_cast.hpp finds for it, to the bit,
/// on any instruction set.
std::uint64_t cast_packet(const EsvoNodes& nodes, EsvoPacket& packet);
std::uint64_t cast_packet(const ContourNodes& nodes, EsvoPacket& packet);

}  // namespace voxdag
