#pragma once
/// The fastest caster of the CPU for each layout.
#include "voxdag/cpu/esvo_packet_caster.hpp"
#include "voxdag/cpu/packet_caster.hpp"
#include "voxdag/trace/streamed_nodes.hpp"

namespace voxdag {

inline PacketCaster fast_caster(const SvdagNodes& nodes) { return PacketCaster(nodes); }

template <EsvoLayout Nodes>
EsvoPacketCaster<Nodes> fast_caster(const Nodes& nodes) {
  return EsvoPacketCaster<Nodes>(nodes);
}

/// Packets do not say which leaves rays end at.
inline ScalarCaster<StreamedNodes> fast_caster(const StreamedNodes& nodes) {
  return ScalarCaster<StreamedNodes>(nodes);
}

}  // namespace voxdag
