#pragma once
/// The distance from a triangle, the simplest way.
#include <algorithm>
#include <cmath>

#include "voxdag/core/vec.hpp"

namespace voxdag::test {

inline double distance_to_segment(Vec3d p, Vec3d a, Vec3d b) {
  const Vec3d along = b - a;
  const double length2 = dot(along, along);
  const double share = length2 > 0 ? std::clamp(dot(p - a, along) / length2, 0.0, 1.0) : 0;
  const Vec3d to = p - a - along * share;
  return std::sqrt(dot(to, to));
}

inline double distance_to_triangle(Vec3d p, Vec3d a, Vec3d b, Vec3d c) {
  double least = std::min(
      {distance_to_segment(p, a, b), distance_to_segment(p, b, c), distance_to_segment(p, c, a)});
  const Vec3d n = cross(b - a, c - a);
  const double length = std::sqrt(dot(n, n));
  if (length > 0 && dot(cross(b - a, p - a), n) >= 0 && dot(cross(c - b, p - b), n) >= 0 &&
      dot(cross(a - c, p - c), n) >= 0)
    least = std::min(least, std::fabs(dot(p - a, n)) / length);
  return least;
}

}  // namespace voxdag::test
