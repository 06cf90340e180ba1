#pragma once
/// Counts the steps of walks through nodes.
#include <cstdint>

#include "voxdag/core/host_device.hpp"

namespace voxdag {

/// A node layout that behaves like `Nodes` and counts the steps of walks.
template <class Nodes>
class CountingNodes : public Nodes {
 public:
  VOXDAG_HD CountingNodes(const Nodes& nodes, std::uint32_t& steps)
      : Nodes(nodes), steps_(&steps) {}

  VOXDAG_HD void on_step() const { ++*steps_; }

 private:
  std::uint32_t* steps_;
};

}  // namespace voxdag
