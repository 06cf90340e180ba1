#pragma once
/// A node whose pointers come with the boxes of the children. It has 32-bit words:
///
///   child mask | box of the node | pointer, ... | box of the child, ...
#include <cstdint>

#include "voxdag/cpu/packets/cell_box.hpp"

namespace voxdag {

/// The number of words of a node.
inline std::uint64_t bounded_node_words(std::uint32_t mask) {
  return 2 + 2 * static_cast<std::uint64_t>(popcount8(mask));
}

inline CellBox bounded_node_box(const std::uint32_t* node) { return {node[1]}; }

/// Returns the pointer of the child in octant `index`, which must be present.
inline std::uint32_t bounded_node_child(const std::uint32_t* node, std::uint32_t index) {
  return node[2 + popcount8(node[0] & ((1u << index) - 1))];
}

/// A pointer, and the box of the child.
struct BoundedChild {
  std::uint32_t pointer;
  CellBox box;
};

/// Writes a node. Calls child(i, octant) for the BoundedChild of each octant of `mask`, with i = 0,
/// 1, ... in the order of the octants. Returns the node's box.
template <class Child>
CellBox write_bounded_node(std::uint32_t mask, std::uint32_t* node, const Child& child) {
  const auto count = static_cast<std::uint32_t>(popcount8(mask));
  std::uint32_t* const pointers = node + 2;
  std::uint32_t* const boxes = pointers + count;
  CellExtent extent;
  std::uint32_t rest = mask;
  for (std::uint32_t i = 0; i < count; ++i, rest &= rest - 1) {
    const auto octant = static_cast<std::uint32_t>(lowest_bit64(rest));
    const BoundedChild next = child(i, octant);
    extent.add(next.box, octant);
    pointers[i] = next.pointer;
    boxes[i] = next.box.bits;
  }
  node[0] = mask;
  node[1] = extent.box().bits;
  return extent.box();
}

}  // namespace voxdag
