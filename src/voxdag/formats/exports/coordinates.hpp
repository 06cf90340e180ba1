#pragma once
/// The text and the precision of coordinates in exported files.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>

#include "voxdag/core/grid.hpp"

namespace voxdag {

/// Returns the shortest decimal that reads back as `value`, a float or a double.
template <class T>
std::string shortest(T value) {
  char text[32];
  const auto result = std::to_chars(text, text + sizeof text, value);
  return {text, result.ptr};
}

/// Returns whether float coordinates are exact to 1/16 voxel in the whole grid.
inline bool float_suffices(const Grid& grid) {
  const Box3d bounds = grid.bounds();
  double largest = 0;
  for (int axis = 0; axis < 3; ++axis)
    largest = std::max({largest, std::abs(bounds.lo[axis]), std::abs(bounds.hi[axis])});
  return largest * 0x1p-24 <= grid.voxel_size / 16 && largest < std::numeric_limits<float>::max() &&
         grid.voxel_size > 16 * std::numeric_limits<float>::min();
}

}  // namespace voxdag
