#pragma once
/// A node whose pointers come with the boxes of the children. It has 32-bit words:
///
///   child mask | box of the node | pointer, ... | box of the child, ...
#include <algorithm>
#include <cstdint>

#include "voxdag/core/bits.hpp"

namespace voxdag {

/// A box in a cell, in 32nds of the cell's side. 30 bits: five each for the first 32nd with voxels
/// along x, y and z, then five each for the last one. Boxes of smaller voxels are rounded outwards.
///
/// A surface fills only a small part of the cells that it crosses. Rays that pass beside it, or
/// start on it, meet these cells but not their boxes.
struct CellBox {
  static constexpr int kBits = 5;
  static constexpr std::uint32_t kParts = 1u << kBits, kLast = kParts - 1;

  std::uint32_t bits = 0;
};

/// The box around boxes of octants, in 32nds of the parent's side.
struct CellExtent {
  std::uint32_t first[3] = {CellBox::kLast, CellBox::kLast, CellBox::kLast}, last[3] = {0, 0, 0};

  /// Adds the box of octant `index`.
  void add(CellBox box, std::uint32_t index) {
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
      const std::uint32_t begin = (index >> axis & 1u) * CellBox::kParts;
      const std::uint32_t low = box.bits >> (CellBox::kBits * axis) & CellBox::kLast;
      const std::uint32_t high = box.bits >> (CellBox::kBits * (axis + 3)) & CellBox::kLast;
      first[axis] = std::min(first[axis], (begin + low) / 2);
      last[axis] = std::max(last[axis], (begin + high) / 2);
    }
  }
  CellBox box() const {
    CellBox box;
    for (std::uint32_t axis = 0; axis < 3; ++axis)
      box.bits |= first[axis] << (CellBox::kBits * axis) | last[axis]
                                                               << (CellBox::kBits * (axis + 3));
    return box;
  }
};

/// Returns the box of the voxels of a leaf block, which must have voxels.
inline CellBox box_of(std::uint64_t block) {
  constexpr std::uint64_t kOdd[3] = {0xAAAAAAAAAAAAAAAAu, 0xCCCCCCCCCCCCCCCCu, 0xF0F0F0F0F0F0F0F0u};
  constexpr std::uint64_t kUpper[3] = {0xFF00FF00FF00FF00u, 0xFFFF0000FFFF0000u,
                                       0xFFFFFFFF00000000u};
  constexpr std::uint32_t kVoxel = CellBox::kParts / 4;
  CellExtent extent;
  for (int axis = 0; axis < 3; ++axis) {
    std::uint32_t slices = 0;  // Bit i is set if there is a voxel at coordinate i.
    for (std::uint32_t i = 0; i < 4; ++i) {
      const std::uint64_t slice = ((i & 1u) != 0 ? kOdd[axis] : ~kOdd[axis]) &
                                  ((i & 2u) != 0 ? kUpper[axis] : ~kUpper[axis]);
      slices |= (block & slice) != 0 ? 1u << i : 0u;
    }
    extent.first[axis] = static_cast<std::uint32_t>(lowest_bit64(slices)) * kVoxel;
    extent.last[axis] = static_cast<std::uint32_t>(highest_bit(slices) + 1) * kVoxel - 1;
  }
  return extent.box();
}

/// Returns the box of a brick of eight leaf blocks; blocks without voxels are 0.
inline CellBox box_of(const std::uint64_t (&leaves)[8]) {
  CellExtent extent;
  for (std::uint32_t octant = 0; octant < 8; ++octant)
    if (leaves[octant] != 0) extent.add(box_of(leaves[octant]), octant);
  return extent.box();
}

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
