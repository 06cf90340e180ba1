#pragma once
/// Tests whether a shape is near a surface.
#include <span>

#include "voxdag/esvo/shape/convex_polyhedron.hpp"
#include "voxdag/esvo/shape/surface_polygon.hpp"

namespace voxdag {

/// A convex polygon and the unit normal of its plane, which is zero if the polygon is a segment or
/// a point.
struct PlanarPolygon {
  const SurfacePolygon* polygon;
  Vec3f normal;
};

/// Largest number of polygons that is_near_surface() tests.
inline constexpr std::size_t kMostNearPolygons = 24;

/// Returns whether each vertex of the shape, and the mean of the vertices, is within `distance` of
/// one of the polygons. Returns true for an empty shape. Otherwise returns false if there are more
/// than kMostNearPolygons polygons or the distance is 0.
bool is_near_surface(const ConvexPolyhedron& shape, std::span<const PlanarPolygon> surface,
                     float distance);

}  // namespace voxdag
