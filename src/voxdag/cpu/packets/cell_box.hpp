#pragma once
/// Boxes around the voxels in a cell.
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

}  // namespace voxdag
