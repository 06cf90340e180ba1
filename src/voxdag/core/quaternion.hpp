#pragma once
/// Turns as quaternions.
#include <array>
#include <cmath>

#include "voxdag/core/error.hpp"
#include "voxdag/core/vec.hpp"

namespace voxdag {

/// Returns the directions of the axes, of unit length, after the turn by a quaternion (x, y, z, w)
/// of any length. Throws Error if its length is 0 or not finite.
inline std::array<Vec3d, 3> turned_axes(double x, double y, double z, double w) {
  const double size = std::sqrt(x * x + y * y + z * z + w * w);
  if (!(size > 0) || !std::isfinite(size)) throw Error("the quaternion of the turn has no length");
  x /= size, y /= size, z /= size, w /= size;
  return {{{1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)},
           {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)},
           {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)}}};
}

}  // namespace voxdag
