#pragma once
/// Selects the types for which kernels are compiled by the layout at run time.
#include "voxdag/cuda/device_voxels.hpp"
#include "voxdag/trace/esvo_cast.hpp"
#include "voxdag/trace/refill_caster.hpp"
#include "voxdag/trace/svdag_nodes.hpp"

namespace voxdag {

/// Calls body(nodes) with the node layout for rays.
template <class Body>
void with_nodes(const DeviceVoxels& voxels, const Body& body) {
  if (voxels.layout == DeviceLayout::kContours)
    body(ContourNodes(voxels.esvo));
  else if (voxels.layout == DeviceLayout::kCubes)
    body(EsvoNodes(voxels.esvo));
  else if (voxels.layout == DeviceLayout::kTop)
    body(TopNodes(voxels.paper, voxels.top));
  else
    body(SvdagNodes(voxels.paper));
}

/// Calls body(nodes) with the node layout for beams and for counting steps.
template <class Body>
void with_beam_nodes(const DeviceVoxels& voxels, const Body& body) {
  if (voxels.layout == DeviceLayout::kContours)
    body(ContourNodes(voxels.esvo));
  else if (voxels.layout == DeviceLayout::kCubes)
    body(EsvoNodes(voxels.esvo));
  else
    body(SvdagNodes(voxels.paper));
}

/// Returns the caster of a thread at these nodes.
template <class Nodes>
ScalarCaster<Nodes> thread_caster(const Nodes& nodes) {
  return ScalarCaster<Nodes>(nodes);
}
inline RefillCaster<> thread_caster(const TopNodes& nodes) { return RefillCaster<>(nodes); }

/// Calls body(beam_nodes, nodes) with both node layouts.
template <class Body>
void with_all_nodes(const DeviceVoxels& voxels, const Body& body) {
  with_nodes(voxels, [&]<class Nodes>(const Nodes& nodes) {
    if constexpr (EsvoLayout<Nodes>)
      body(nodes, nodes);
    else
      body(SvdagNodes(voxels.paper), nodes);
  });
}

}  // namespace voxdag
