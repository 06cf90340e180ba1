#pragma once
/// The fastest caster of the CPU for each layout.
#include "voxdag/cpu/packet_caster.hpp"
#include "voxdag/trace/esvo_cast.hpp"

namespace voxdag {

inline PacketCaster fast_caster(const SvdagNodes& nodes) { return PacketCaster(nodes); }

template <EsvoLayout Nodes>
ScalarCaster<Nodes> fast_caster(const Nodes& nodes) {
  return ScalarCaster<Nodes>(nodes);
}

}  // namespace voxdag
