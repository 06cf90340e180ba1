#pragma once
/// Tests whether a shape is near a surface.
#include <span>

#include "voxdag/builders/esvo/shape/convex_polyhedron.hpp"
#include "voxdag/builders/pieces/surface_polygon.hpp"

namespace voxdag {

/// A convex polygon and the unit normal of its plane, which is zero if the polygon is a segment or
/// a point.
struct PlanarPolygon {
  const SurfacePolygon* polygon;
  Vec3f normal;
};

/// Returns whether each vertex of the shape, and the mean of the vertices, is within `distance` of
/// one of the polygons. If more than 24 polygons are smaller than the shape's cell, each octant of
/// the shape must be near them too, and so on: a gap between many small polygons is not overlooked.
/// Ends at octants that are wider than at most 24 of the polygons near them, or at most 4 *
/// `distance` wide. The time is about proportional to the number of polygons. Returns true for an
/// empty shape. Otherwise returns false if there are no polygons or the distance is 0.
bool is_near_surface(const ConvexPolyhedron& shape, std::span<const PlanarPolygon> surface,
                     float distance);

}  // namespace voxdag
