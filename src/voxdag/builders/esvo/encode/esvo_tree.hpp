#pragma once
/// A part of an ESVO under construction: nodes that are not yet in blocks.
#include <cstdint>
#include <vector>

#include "voxdag/builders/pieces/voxel_value.hpp"
#include "voxdag/core/bits.hpp"
#include "voxdag/stored/esvo/contour.hpp"

namespace voxdag {

/// An inner voxel: the contents of its child descriptor. Lists are in the order of the children.
struct EsvoNode {
  /// Index of the first inner child among the nodes; greater than this node's index. If
  /// `is_packed`, the children are in a block already, and this is an index into EsvoTree::packed.
  std::uint32_t first_child = 0;
  std::uint32_t first_contour = 0;  ///< In EsvoTree::contours; one per bit of contour_mask.
  std::uint32_t first_value = 0;    ///< In EsvoTree::values; one per bit of valid_mask.
  std::uint8_t valid_mask = 0, leaf_mask = 0, contour_mask = 0;
  bool is_packed = false;

  std::uint32_t inner_mask() const { return valid_mask & ~std::uint32_t{leaf_mask}; }
  std::uint32_t inner_count() const { return static_cast<std::uint32_t>(popcount8(inner_mask())); }
};

/// Node 0 is the root of the part. Every other node is the child of exactly one node.
struct EsvoTree {
  std::vector<EsvoNode> nodes;
  std::vector<Contour> contours;
  std::vector<VoxelValue> values;     ///< Empty in an octree without attributes.
  std::vector<std::uint64_t> packed;  ///< Slots of the first descriptors of packed children.

  bool has_values() const { return !values.empty(); }
};

}  // namespace voxdag
