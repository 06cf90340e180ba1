#pragma once
/// The part of a triangle in a cell: a convex polygon, in the coordinates in which the cell is
/// [-1,1]³.
///
/// Each level cuts the polygons of the parent level (Sutherland and Hodgman, "Reentrant Polygon
/// Clipping", 1974) and doubles their coordinates, which is exact. If rounding lost a point at one
/// level, the levels below would have a hole. So a corner outside the cutting plane, but within
/// 1e-9 of it, counts as inside and is moved onto the plane.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>

#include "voxdag/core/vec.hpp"

namespace voxdag {

struct SurfacePolygon {
  static constexpr int kMaxCorners = 12;
  static constexpr std::uint8_t kCutEdge = 3;
  static constexpr double kSlack = 1e-9;  ///< Corners nearer to a plane than this lie on it.

  // Copies only the corners in use.
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
  /// The source of the edge from corner i to the next: the number of the triangle's edge (0, 1 or
  /// 2, the corner at which it begins), or kCutEdge.
  std::uint8_t edges[kMaxCorners];

  static SurfacePolygon triangle(Vec3d a, Vec3d b, Vec3d c) {
    SurfacePolygon p;
    p.count = 3;
    p.corners[0] = a, p.corners[1] = b, p.corners[2] = c;
    p.edges[0] = 0, p.edges[1] = 1, p.edges[2] = 2;
    return p;
  }

  /// Becomes the part of `whole`, another polygon, where sign * (p[axis] - position) >= 0; sign is
  /// 1 or -1.
  void become_part(const SurfacePolygon& whole, int axis, double position, double sign) {
    double distances[kMaxCorners];
    unsigned inside = 0, on_plane = 0;
    const int n = whole.count;
    for (int i = 0; i < n; ++i) {
      const double distance = sign * (whole.corners[i][axis] - position);
      const bool is_on_plane = std::fabs(distance) < kSlack;
      distances[i] = is_on_plane ? 0 : distance;
      on_plane |= static_cast<unsigned>(is_on_plane) << i;
      inside |= static_cast<unsigned>(distances[i] >= 0) << i;
    }
    const auto is_inside = [&](int i) { return (inside >> i & 1) != 0; };
    const auto add_corner = [&](int i) {
      if (count == kMaxCorners) return;
      corners[count] = whole.corners[i];
      if ((on_plane >> i & 1) != 0) corners[count][axis] = position;
      edges[count++] = whole.edges[i];
    };
    const auto add_cut = [&](int i, int next, std::uint8_t edge) {
      if (count == kMaxCorners) return;
      const Vec3d from = whole.corners[i];
      const double share = distances[i] / (distances[i] - distances[next]);
      corners[count] = from + (whole.corners[next] - from) * share;
      corners[count][axis] = position;
      edges[count++] = edge;
    };
    count = 0;
    if (inside == 0) return;
    // The corners whose predecessors are outside. Without rounding, a convex polygon has at most
    // one.
    const unsigned after = (inside << 1 | inside >> (n - 1)) & ((1u << n) - 1);
    unsigned entries = inside & ~after;
    if (entries == 0)
      for (int i = 0; i < n; ++i) add_corner(i);
    for (; entries != 0; entries &= entries - 1) {
      int i = std::countr_zero(entries), next = i;
      const int before = i == 0 ? n - 1 : i - 1;
      if (distances[i] > 0) add_cut(before, i, whole.edges[before]);
      do {
        i = next;
        add_corner(i);
        next = i + 1 == n ? 0 : i + 1;
      } while (is_inside(next));
      if (distances[i] > 0)
        add_cut(i, next, kCutEdge);
      else
        edges[count - 1] = kCutEdge;
    }
  }

  /// Becomes the part of `whole`, another polygon, in octant `child` (x=1, y=2, z=4), enlarged to
  /// [-1,1]³. `axes` (x=1, y=2, z=4) are the axes along which `whole` may be in both halves. If
  /// rounding loses the whole part, a point remains.
  void become_octant(const SurfacePolygon& whole, int child, std::uint32_t axes) {
    SurfacePolygon parts[2];
    const SurfacePolygon* from = &whole;
    for (int axis = 2; axis >= 0; --axis) {
      const double sign = (child >> axis & 1) != 0 ? 1 : -1;
      if ((axes >> axis & 1u) == 0 || from->is_inside(axis, sign)) continue;
      SurfacePolygon& part = from == &parts[0] ? parts[1] : parts[0];
      part.become_part(*from, axis, 0, sign);
      if (part.count == 0) {
        part.become_point(from->corners[0]);
        part.corners[0][axis] = 0;
      }
      from = &part;
    }
    become_enlarged(*from, child);
  }

  /// Becomes `whole`, another polygon that lies in octant `child`, enlarged to [-1,1]³.
  void become_enlarged(const SurfacePolygon& whole, int child) {
    const auto shift = [&](int axis) { return (child >> axis & 1) != 0 ? -1.0 : 1.0; };
    const Vec3d shifts{shift(0), shift(1), shift(2)};
    count = whole.count;
    for (int i = 0; i < count; ++i) {
      corners[i] = whole.corners[i] * 2.0 + shifts;
      edges[i] = whole.edges[i];
    }
  }

  /// Keeps the part in [-1,1]³, or a point there if rounding loses the part.
  void clip_to_cell() {
    bool is_inside = true;
    for (int i = 0; i < count; ++i)
      for (int axis = 0; axis < 3; ++axis) is_inside &= std::fabs(corners[i][axis]) < 1;
    if (is_inside) return;
    SurfacePolygon parts[2];
    const SurfacePolygon* from = this;
    for (int axis = 0; axis < 3; ++axis)
      for (const int side : {0, 1}) {
        parts[side].become_part(*from, axis, 2 * side - 1, 1 - 2 * side);
        from = &parts[side];
      }
    if (from->count > 0) {
      *this = *from;
      return;
    }
    become_point(corners[0]);
    for (int axis = 0; axis < 3; ++axis) corners[0][axis] = std::clamp(corners[0][axis], -1.0, 1.0);
  }

  void become_point(Vec3d point) {
    count = 1;
    corners[0] = point;
    edges[0] = kCutEdge;
  }

  /// One octant (x=1, y=2, z=4), or two that share a side.
  struct Octants {
    std::uint32_t first, last;
  };
  /// Returns the octants that contain the polygon. Returns nothing if there are more than two, or
  /// if rounding could change the result.
  std::optional<Octants> octants() const {
    // A corner moves by at most kSlack, and each of twenty levels doubles that.
    constexpr double kDoubt = kSlack * (1 << 20);
    if (count < 3) return std::nullopt;
    Vec3d least = corners[0], most = corners[0];
    for (int i = 1; i < count; ++i) {
      least = min(least, corners[i]);
      most = max(most, corners[i]);
    }
    Octants octants{0, 0};
    for (int axis = 0; axis < 3; ++axis) {
      if (std::min(std::fabs(least[axis]), std::fabs(most[axis])) < kDoubt) return std::nullopt;
      octants.first |= (least[axis] > 0 ? 1u : 0u) << axis;
      octants.last |= (most[axis] > 0 ? 1u : 0u) << axis;
    }
    if (std::popcount(octants.first ^ octants.last) > 1) return std::nullopt;
    return octants;
  }

  /// Returns whether all corners lie on the side `sign` (1 or -1) of 0 along an axis, by more than
  /// kSlack.
  bool is_inside(int axis, double sign) const {
    bool is_inside = true;
    for (int i = 0; i < count; ++i) is_inside &= sign * corners[i][axis] >= kSlack;
    return is_inside;
  }

  /// Returns the vector area: its length is the area, its direction the normal.
  Vec3d area() const {
    Vec3d sum{};
    for (int i = 2; i < count; ++i)
      sum = sum + cross(corners[i - 1] - corners[0], corners[i] - corners[0]);
    return sum * 0.5;
  }
};

}  // namespace voxdag
