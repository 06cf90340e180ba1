// Casts packets of up to 64 beams from one point. Compiled once for each instruction set; the best
// one that the machine has is chosen at run time.
//
// The walk is that of trace/beam.hpp (depth first, nearest octants first) with a beam in each lane.
// For all beams that meet a node, it finds the children that they meet, and the t at which they
// meet them. It computes in float, and moves t outwards by more than all rounding errors.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "voxdag/cpu/packets/cast_beam_packet.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "voxdag/cpu/packets/beam_packet.hpp"
#include "voxdag/cpu/packets/beam_packet_walk-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace voxdag {
namespace HWY_NAMESPACE {

void cast_dag_beams(const SvdagNodes& nodes, BeamPacket& packet) {
  BeamPacketWalk<SvdagNodes>(nodes, packet).cast();
}
void cast_esvo_beams(const EsvoNodes& nodes, BeamPacket& packet) {
  BeamPacketWalk<EsvoNodes>(nodes, packet).cast();
}

}  // namespace HWY_NAMESPACE
}  // namespace voxdag
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace voxdag {

HWY_EXPORT(cast_dag_beams);
HWY_EXPORT(cast_esvo_beams);

void cast_beam_packet(const SvdagNodes& nodes, BeamPacket& packet) {
  HWY_DYNAMIC_DISPATCH(cast_dag_beams)(nodes, packet);
}

void cast_beam_packet(const EsvoNodes& nodes, BeamPacket& packet) {
  HWY_DYNAMIC_DISPATCH(cast_esvo_beams)(nodes, packet);
}

}  // namespace voxdag
#endif
