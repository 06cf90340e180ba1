#pragma once
/// Directions as contours store them.
#include <cmath>

#include "voxdag/stored/esvo/contour.hpp"

namespace voxdag {

/// A direction as contours store it.
struct ContourDirection {
  Vec3i normal{};
  float length = 0;  ///< Length of `normal`; 0 if there is no direction.

  ContourDirection() = default;
  explicit ContourDirection(Vec3i n)
      : normal(n), length(std::sqrt(static_cast<float>(dot(n, n)))) {}

  /// Returns the stored direction nearest to `direction`, or its opposite if only that points up.
  /// Returns a direction that does not exist() for zero.
  static ContourDirection nearest(Vec3d direction);

  bool exists() const { return length > 0; }
};

}  // namespace voxdag
