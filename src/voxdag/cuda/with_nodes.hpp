#pragma once
/// From the layout that a DAG has at run time to the type that kernels are compiled for.
#include "voxdag/cuda/device_dag.hpp"
#include "voxdag/trace/svdag_nodes.hpp"
#include "voxdag/trace/wide_cast.hpp"

namespace voxdag {

/// Calls body(nodes) with what rays are cast at.
template <class Body>
void with_nodes(const DeviceDag& dag, const Body& body) {
  if (dag.layout == DeviceLayout::kWide)
    body(WideNodes(dag.wide));
  else
    body(SvdagNodes(dag.paper));
}

}  // namespace voxdag
