#pragma once
/// The node layouts for rays at an ESVO (stored/esvo/esvo.hpp), whose leaves may be of any level.
///
/// They are node layouts as svdag_nodes.hpp describes them. A walk that does not handle coarse
/// leaves sees a full subtree: all cells below the leaf are present, down to the voxels. A walk
/// that handles them calls is_leaf().
#include <concepts>

#include "voxdag/stored/esvo/esvo.hpp"

namespace voxdag {

struct EsvoHit;  // trace/esvo_cast.hpp

/// Voxels as cubes. Nodes are slots of descriptors.
class EsvoNodes {
 public:
  using Node = std::uint64_t;
  using Found = EsvoHit;
  /// Whether cast() cuts the cubes by their contours; other walks never do.
  static constexpr bool kWithContours = false;

  VOXDAG_HD explicit EsvoNodes(const EsvoView& esvo) : esvo_(esvo) {}

  VOXDAG_HD bool is_empty() const { return esvo_.is_empty(); }
  VOXDAG_HD int levels() const { return esvo_.levels; }
  VOXDAG_HD Node root() const { return esvo_.root; }
  VOXDAG_HD const EsvoView& view() const { return esvo_; }

  VOXDAG_HD std::uint32_t child_mask(Node node, int /*level*/) const {
    return node == kFull ? 0xFFu : esvo_.descriptor(node).valid_mask();
  }
  VOXDAG_HD Node child(Node node, int level, int index) const {
    if (is_leaf(node, level, index)) return kFull;
    return esvo_.child(node, esvo_.descriptor(node), index);
  }
  /// Returns whether child `index`, which must be present, is a leaf.
  VOXDAG_HD bool is_leaf(Node node, int /*level*/, int index) const {
    return node == kFull || (esvo_.descriptor(node).leaf_mask() >> index & 1u) != 0;
  }

 private:
  static constexpr Node kFull = ~std::uint64_t{0};  ///< Stands for any node inside of a leaf.

  EsvoView esvo_;
};

/// Voxels in their shapes: cubes cut by their own contours and those of all ancestors.
class ContourNodes : public EsvoNodes {
 public:
  static constexpr bool kWithContours = true;
  using EsvoNodes::EsvoNodes;
};

/// A node layout of an ESVO: leaves are of any level, and its rays hit EsvoHit.
template <class Nodes>
concept EsvoLayout = std::derived_from<Nodes, EsvoNodes>;

/// Returns whether child `index`, present in `node` of `level`, is a voxel or a coarser leaf.
template <class Nodes>
VOXDAG_HD inline bool is_leaf_child(const Nodes& nodes, typename Nodes::Node node, int level,
                                    int index) {
  if constexpr (EsvoLayout<Nodes>)
    return nodes.is_leaf(node, level, index);
  else
    return level + 1 == nodes.levels();
}

}  // namespace voxdag
