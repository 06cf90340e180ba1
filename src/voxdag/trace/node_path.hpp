#pragma once
/// The position of a walk in the tree: the nodes from the root down to the one whose children it
/// visits.
#include <cstdint>

#include "voxdag/core/grid.hpp"
#include "voxdag/core/host_device.hpp"

namespace voxdag {

/// The path of a walk at any layout (svdag_nodes.hpp lists what a layout has). A layout with a
/// faster one names it as its type Path, which has the same members. The caller owns the stack of
/// kMaxLevels entries: nvcc keeps an object with an array in memory, and one without in registers.
template <class Nodes>
class NodePath {
 public:
  using Entry = typename Nodes::Node;

  /// Starts at the root. The layout must not be empty.
  VOXDAG_HD explicit NodePath(const Nodes& nodes)
      : nodes_(nodes), node_(nodes.root()), mask_(nodes.child_mask(node_, 0)) {}

  /// Returns the child mask of the node.
  VOXDAG_HD std::uint32_t mask() const { return mask_; }
  /// Goes to child `index` of the node, which is present and of `level` < L.
  VOXDAG_HD void push(Entry* stack, int level, std::uint32_t index) {
    stack[level - 1] = node_;
    node_ = nodes_.child(node_, level - 1, static_cast<int>(index));
    mask_ = nodes_.child_mask(node_, level);
  }
  /// Goes back to the node on the path whose children have this level, which is less than now.
  VOXDAG_HD void pop(const Entry* stack, int level) {
    node_ = stack[level - 1];
    mask_ = nodes_.child_mask(node_, level - 1);
  }

 private:
  const Nodes& nodes_;
  Entry node_;
  std::uint32_t mask_;
};

template <class Nodes>
struct PathOf {
  using Type = NodePath<Nodes>;
};
template <class Nodes>
requires requires { typename Nodes::Path; }
struct PathOf<Nodes> {
  using Type = typename Nodes::Path;
};

}  // namespace voxdag
