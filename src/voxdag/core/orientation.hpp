#pragma once
/// The symmetries of a cube.
#include "voxdag/core/vec.hpp"

namespace voxdag {

/// One of the 48 symmetries of a cube: coordinate a of a voxel of the result is coordinate
/// source_axis[a] of the source's voxel, counted from the other side of the grid if is_flipped[a].
struct Orientation {
  int source_axis[3] = {0, 1, 2};  ///< A permutation.
  bool is_flipped[3] = {};

  friend bool operator==(const Orientation&, const Orientation&) = default;
};

/// Returns the source's cell of a cell of the result, in grids of 2^levels cells a side.
inline Vec3i source_cell(const Orientation& orientation, Vec3i cell, int levels) {
  Vec3i source;
  for (int axis = 0; axis < 3; ++axis)
    source[orientation.source_axis[axis]] =
        orientation.is_flipped[axis] ? (1 << levels) - 1 - cell[axis] : cell[axis];
  return source;
}

}  // namespace voxdag
