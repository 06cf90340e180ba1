#pragma once
/// A triangle for the builders of octrees: the voxels that it meets, its position and its
/// appearance.
#include <algorithm>
#include <optional>
#include <span>

#include "voxdag/builders/pieces/contour_direction.hpp"
#include "voxdag/builders/pieces/surface_polygon.hpp"
#include "voxdag/builders/voxelize/triangle_setup.hpp"
#include "voxdag/core/vec2.hpp"
#include "voxdag/mesh/surface/surface_shading.hpp"

namespace voxdag {

/// Coordinates are in voxels, relative to the origin of the current cell.
struct SurfaceTriangle {
  // Data that every level reads comes first.
  TriangleSetup setup;
  Vec3d normal{};               ///< Unit length; zero for a triangle without area.
  ContourDirection across;      ///< `normal` as a contour stores it; none if it is zero.
  std::uint32_t source = 0;     ///< Triangle of the mesh.
  bool is_displaced = false;    ///< Its normal differs from the source's.
  std::uint8_t open_edges = 0;  ///< Bit e: no other triangle has the edge that begins at corner e.
  /// The common sample of all points, if they do not differ.
  std::optional<SurfaceSample> constant_sample;
  ContourDirection across_edges[3];  ///< In the plane, perpendicular to each open edge.
  Vec3d corners[3];
  /// The barycentric coordinates of a point p, for corners 1 and 2 of the source triangle, are base
  /// + (dot(u, p), dot(v, p)).
  Vec2d base;
  Vec3d u{}, v{};

  /// Returns a corner relative to `origin`, in voxels.
  static Vec3d corner(Vec3i quantized, Vec3i origin) {
    return static_cast<Vec3d>(quantized) * (1.0 / kSubvoxels) - static_cast<Vec3d>(origin);
  }

  /// Makes a triangle that is not displaced. `origin` is in voxels.
  static SurfaceTriangle make(const QuantizedTriangle& triangle, Vec3i origin, std::uint32_t source,
                              std::uint8_t open_edges) {
    SurfaceTriangle t;
    t.setup = make_triangle_setup(triangle, origin);
    for (int i = 0; i < 3; ++i) t.corners[i] = corner(triangle[i], origin);
    const Vec3d e1 = t.corners[1] - t.corners[0], e2 = t.corners[2] - t.corners[0];
    const Vec3d n = cross(e1, e2);
    const double area2 = dot(n, n);
    if (area2 > 0) {
      t.normal = n * (1 / std::sqrt(area2));
      t.across = ContourDirection::nearest(t.normal);
      for (int e = 0; e < 3; ++e)
        if ((open_edges >> e & 1) != 0)
          t.across_edges[e] =
              ContourDirection::nearest(cross(t.normal, t.corners[(e + 1) % 3] - t.corners[e]));
      t.u = cross(e2, n) * (1 / area2);
      t.v = cross(n, e1) * (1 / area2);
      t.base = {-dot(t.u, t.corners[0]), -dot(t.v, t.corners[0])};
    }
    t.source = source;
    t.open_edges = open_edges;
    return t;
  }

  /// Makes a piece of a displaced triangle. `barycentrics` are the coordinates of its corners in
  /// the source triangle.
  static SurfaceTriangle make_displaced(const QuantizedTriangle& triangle, Vec3i origin,
                                        std::uint32_t source, const Vec2f (&barycentrics)[3]) {
    SurfaceTriangle t = make(triangle, origin, source, 0);
    t.is_displaced = true;
    const auto corner = [&](int i) {
      return Vec2d{static_cast<double>(barycentrics[i].x), static_cast<double>(barycentrics[i].y)};
    };
    const Vec2d at = corner(0), b = corner(1) - at, c = corner(2) - at;
    const Vec2d own = t.base;
    const Vec3d u = t.u, v = t.v;
    t.base = at + b * own.x + c * own.y;
    t.u = u * b.x + v * c.x;
    t.v = u * b.y + v * c.y;
    return t;
  }

  /// Returns the triangle in the coordinates of the cell at `cell`, of 2^log2_size voxels a side.
  /// Does not clip it to the cell.
  SurfacePolygon polygon(Vec3i cell, int log2_size) const {
    return polygon(corners, cell, log2_size);
  }
  static SurfacePolygon polygon(const Vec3d (&corners)[3], Vec3i cell, int log2_size) {
    const double half = 0.5 * static_cast<double>(std::int64_t{1} << log2_size);
    const Vec3d centre = static_cast<Vec3d>(cell) + Vec3d{half, half, half};
    const auto local = [&](int i) { return (corners[i] - centre) * (1 / half); };
    return SurfacePolygon::triangle(local(0), local(1), local(2));
  }

  Vec2f barycentric(Vec3d p) const {
    const double b1 = std::clamp(base.x + dot(u, p), 0.0, 1.0);
    const double b2 = std::clamp(base.y + dot(v, p), 0.0, 1.0 - b1);
    return {static_cast<float>(b1), static_cast<float>(b2)};
  }
};

}  // namespace voxdag
