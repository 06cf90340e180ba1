#pragma once
/// Clips polygons to boxes in double precision: the reference for filtered surfaces.
#include <vector>

#include "voxdag/core/vec.hpp"

namespace voxdag {

using Polygon = std::vector<Vec3d>;

/// Returns the part of a polygon with sign * (p[axis] - at) >= 0.
inline Polygon clipped(const Polygon& polygon, int axis, double at, double sign) {
  Polygon result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3d a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    const double da = sign * (a[axis] - at), db = sign * (b[axis] - at);
    if (da >= 0) result.push_back(a);
    if ((da < 0) != (db < 0)) result.push_back(a + (b - a) * (da / (da - db)));
  }
  return result;
}

/// Returns the part of a polygon in a box.
inline Polygon clipped(Polygon polygon, Vec3d lo, Vec3d hi) {
  for (int axis = 0; axis < 3; ++axis) {
    polygon = clipped(polygon, axis, lo[axis], 1);
    polygon = clipped(polygon, axis, hi[axis], -1);
  }
  return polygon;
}

/// Returns the area of a convex polygon.
inline double area_of(const Polygon& polygon) {
  double area = 0;
  for (std::size_t i = 2; i < polygon.size(); ++i)
    area += length(cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0])) / 2;
  return area;
}

}  // namespace voxdag
