#pragma once
/// The fastest caster of the CPU for each layout but DAGs, for which CpuScene keeps one.
#include "voxdag/cpu/packet_caster.hpp"
#include "voxdag/trace/streamed_nodes.hpp"

namespace voxdag {

template <EsvoLayout Nodes>
PacketCaster<Nodes> fast_caster(const Nodes& nodes) {
  return PacketCaster<Nodes>(nodes);
}

/// Packets do not say which leaves rays end at.
inline ScalarCaster<StreamedNodes> fast_caster(const StreamedNodes& nodes) {
  return ScalarCaster<StreamedNodes>(nodes);
}

}  // namespace voxdag
