#pragma once
/// The part of a triangle in a cell: a convex polygon, in the coordinates in which the cell is
/// [-1,1]³.
///
/// Each level cuts the polygons of the level above (Sutherland and Hodgman, "Reentrant Polygon
/// Clipping", 1974) and doubles their coordinates, which is exact. What is cut by mistake at one
/// level would leave a hole below it, so a corner may lie 1e-9 outside of the plane that cuts, and
/// is moved onto it.
#include <cassert>
#include <cmath>
#include <cstdint>

#include "voxdag/core/vec.hpp"

namespace voxdag {

struct SurfacePolygon {
  static constexpr int kMaxCorners = 12;
  static constexpr std::uint8_t kCutEdge = 3;

  // Most have a few of the corners that there is room for: copies leave out the rest.
  SurfacePolygon() {}
  SurfacePolygon(const SurfacePolygon& other) { *this = other; }
  SurfacePolygon& operator=(const SurfacePolygon& other) {
    if (this == &other) return *this;
    count = other.count;
    for (int i = 0; i < count; ++i) {
      corners[i] = other.corners[i];
      edges[i] = other.edges[i];
    }
    return *this;
  }

  int count = 0;
  union {
    Vec3d corners[kMaxCorners];  // uninitialised
  };
  /// What the edge from corner i to the next is: 0, 1, 2 the triangle's edge that begins at that
  /// corner of it, or kCutEdge.
  std::uint8_t edges[kMaxCorners];

  static SurfacePolygon triangle(Vec3d a, Vec3d b, Vec3d c) {
    SurfacePolygon p;
    p.count = 3;
    p.corners[0] = a, p.corners[1] = b, p.corners[2] = c;
    p.edges[0] = 0, p.edges[1] = 1, p.edges[2] = 2;
    return p;
  }

  /// Keeps where sign * (p[axis] - position) >= 0; sign is 1 or -1.
  void clip(int axis, double position, double sign) {
    constexpr double kSlack = 1e-9;
    double distances[kMaxCorners];
    bool all = true;
    for (int i = 0; i < count; ++i) {
      distances[i] = sign * (corners[i][axis] - position);
      if (std::fabs(distances[i]) < kSlack) distances[i] = 0;
      all &= distances[i] > 0;
    }
    if (all) return;
    SurfacePolygon result;
    const auto add = [&](Vec3d corner, std::uint8_t edge) {
      if (result.count == kMaxCorners) return;
      result.corners[result.count] = corner;
      result.edges[result.count++] = edge;
    };
    for (int i = 0; i < count; ++i) {
      const int next = i + 1 == count ? 0 : i + 1;
      const double here = distances[i], there = distances[next];
      if (here >= 0) {
        Vec3d corner = corners[i];
        if (here == 0) corner[axis] = position;
        add(corner, here == 0 && there < 0 ? kCutEdge : edges[i]);
      }
      if (!(here > 0 && there < 0) && !(here < 0 && there > 0)) continue;
      Vec3d corner = corners[i] + (corners[next] - corners[i]) * (here / (here - there));
      corner[axis] = position;
      add(corner, here > 0 ? kCutEdge : edges[i]);
    }
    *this = result;
  }

  /// The same corners in the coordinates of the cell's octant `child`.
  SurfacePolygon in_octant(int child) const {
    SurfacePolygon p = *this;
    for (int i = 0; i < p.count; ++i)
      for (int axis = 0; axis < 3; ++axis)
        p.corners[i][axis] = 2 * p.corners[i][axis] - ((child >> axis & 1) != 0 ? 1.0 : -1.0);
    return p;
  }

  /// The part in the octant `child`, in the octant's coordinates.
  SurfacePolygon octant(int child) const {
    SurfacePolygon p(*this);
    for (int axis = 0; axis < 3; ++axis) p.clip(axis, 0, (child >> axis & 1) != 0 ? 1.0 : -1.0);
    return p.in_octant(child);
  }

  /// The part in [-1,1]³.
  void clip_to_cell() {
    for (int axis = 0; axis < 3; ++axis) {
      clip(axis, -1, 1);
      clip(axis, 1, -1);
    }
  }

  /// The vector area: its length is the area, its direction the normal.
  Vec3d area() const {
    Vec3d sum{};
    for (int i = 2; i < count; ++i)
      sum = sum + cross(corners[i - 1] - corners[0], corners[i] - corners[0]);
    return sum * 0.5;
  }
};

/// Whether a point is no farther from a polygon than `distance`. Its plane has the unit normal
/// given (or zero, where the polygon is a segment or a point).
inline bool is_within(const SurfacePolygon& polygon, Vec3d normal, Vec3d point, double distance) {
  if (polygon.count == 0) return false;
  const double height = dot(normal, point - polygon.corners[0]);
  if (height > distance || height < -distance) return false;
  bool inside = polygon.count > 2 && dot(normal, normal) > 0;
  for (int i = 0; i < polygon.count; ++i) {
    const Vec3d a = polygon.corners[i];
    const Vec3d edge = polygon.corners[i + 1 == polygon.count ? 0 : i + 1] - a;
    const Vec3d to = point - a;
    inside = inside && dot(cross(normal, edge), to) >= 0;
    const double length2 = dot(edge, edge), along = dot(to, edge);
    const Vec3d d = along <= 0 ? to : along >= length2 ? to - edge : to - edge * (along / length2);
    if (dot(d, d) <= distance * distance) return true;
  }
  return inside;
}

}  // namespace voxdag
