#pragma once
/// The contour that takes away most of what a voxel's shape has beyond its surface.
///
/// Source: Laine and Karras, "Efficient Sparse Voxel Octrees", I3D 2010, section 3.4: of some
/// candidate directions, the one in which the shape's extent exceeds the surface's most; planes
/// across it as near to the surface as they can be stored, never nearer.
#include <array>
#include <optional>
#include <span>

#include "voxdag/esvo/convex_polyhedron.hpp"
#include "voxdag/esvo/surface_polygon.hpp"
#include "voxdag/layout/contour.hpp"

namespace voxdag {

/// The stored normal whose direction is nearest to that of `direction`, which is not zero.
Vec3i quantize_direction(Vec3d direction);

/// Directions to choose from, quantised; a few that differ well.
class ContourCandidates {
 public:
  static constexpr int kMost = 8;

  /// Adds a direction unless one like it (or its opposite) is there, or adds to that one's weight.
  /// Where there is no room the lightest goes.
  void add(Vec3i normal, double weight);

  std::span<const Vec3i> normals() const { return {normals_.data(), count_}; }

 private:
  std::size_t count_ = 0;
  std::array<Vec3i, kMost> normals_{};
  std::array<double, kMost> weights_{};
};

struct FittedContour {
  Contour contour;
  /// By how much the shape becomes thinner across it, in the voxel's coordinates: its side is 2.
  double gain = 0;
};

/// The best contour, or none if the shape nowhere exceeds the surface. The surface lies between
/// the planes by a margin that exceeds all rounding here and in the ray casts. `points` are the
/// corners of the polygons in the voxel; at least one.
std::optional<FittedContour> fit_contour(const ConvexPolyhedron& shape,
                                         std::span<const SurfacePolygon* const> surface,
                                         const ContourCandidates& candidates);

/// Cuts the shape by the contour's planes.
void clip_to_contour(ConvexPolyhedron& shape, Contour contour);

}  // namespace voxdag
