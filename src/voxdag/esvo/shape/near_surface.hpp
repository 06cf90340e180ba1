#pragma once
/// Whether a shape is near to a surface.
#include <span>

#include "voxdag/esvo/shape/convex_polyhedron.hpp"
#include "voxdag/esvo/shape/surface_polygon.hpp"

namespace voxdag {

/// A convex polygon and the unit normal of its plane: zero where the polygon is a segment or a
/// point.
struct PlanarPolygon {
  const SurfacePolygon* polygon;
  Vec3f normal;
};

/// More are not looked at.
inline constexpr std::size_t kMostNearPolygons = 24;

/// Whether the shape's vertices and their mean are each no farther than `distance` from one of the
/// polygons. An empty shape is; any other is not where there are more than kMostNearPolygons, or
/// the distance is 0.
bool is_near_surface(const ConvexPolyhedron& shape, std::span<const PlanarPolygon> surface,
                     float distance);

}  // namespace voxdag
