#pragma once
/// Packets of beams.
#include <cstddef>

#include "voxdag/trace/beam.hpp"
#include "voxdag/trace/svdag_nodes.hpp"

namespace voxdag {

/// Up to 64 beams from one point (trace/beam.hpp), and where they first meet anything. Arrays are
/// indexed by axis, then by beam.
struct BeamPacket {
  static constexpr std::size_t kMaxBeams = 64;

  Vec3d apex{};
  BeamStop stop;
  double lowest[3][kMaxBeams], highest[3][kMaxBeams];
  std::size_t size = 0;
  /// A t before which no ray of the beam meets anything; +infinity if no ray meets anything. It is
  /// the bound of first_met(), rounded down to float.
  alignas(64) float first[kMaxBeams];

  void add(const Vec3d& low, const Vec3d& high) {
    for (int axis = 0; axis < 3; ++axis) {
      lowest[axis][size] = low[axis];
      highest[axis][size] = high[axis];
    }
    ++size;
  }
};

/// Sets packet.first of every beam. There must be at least one beam.
void cast_beam_packet(const SvdagNodes& nodes, BeamPacket& packet);
void cast_beam_packet(const EsvoNodes& nodes, BeamPacket& packet);

}  // namespace voxdag
