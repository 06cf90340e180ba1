#pragma once
/// Finds the contour that removes most of the part of a voxel's shape that lies beyond its surface.
///
/// Source: Laine and Karras, "Efficient Sparse Voxel Octrees", I3D 2010, section 3.4. Chooses, from
/// some candidate directions, the one along which the shape's extent exceeds the surface's most.
/// Rounds the two planes outwards to positions that can be stored.
#include <array>
#include <cmath>
#include <optional>
#include <span>

#include "voxdag/builders/esvo/shape/convex_polyhedron.hpp"
#include "voxdag/builders/esvo/shape/near_surface.hpp"
#include "voxdag/builders/pieces/contour_direction.hpp"
#include "voxdag/core/interval.hpp"
#include "voxdag/stored/esvo/contour.hpp"

namespace voxdag {

/// A few candidate directions that are not similar to each other.
class ContourCandidates {
 public:
  static constexpr int kMax = 8;

  /// Adds a direction. If a similar one (or its opposite) exists, adds to its weight instead. If
  /// the set is full, replaces the direction of least weight.
  void add(const ContourDirection& direction, double weight);

  std::span<const ContourDirection> directions() const { return {directions_.data(), count_}; }

 private:
  std::size_t count_ = 0;
  std::array<ContourDirection, kMax> directions_;
  std::array<double, kMax> weights_;
};

struct FittedContour {
  Contour contour;
  /// The thickness that the contour removes from the shape, in the voxel's coordinates: its side is
  /// 2.
  double gain = 0;

  /// A contour with less gain is not worth its four bytes, unless it makes the voxel a leaf;
  /// without it each child would need a contour.
  static constexpr double kMinGain = 0.15;
  bool pays() const { return gain > kMinGain; }
};

/// Returns the least and the greatest dot(normal, p) of the shape's points p.
Interval extent_of(const ConvexPolyhedron& shape, Vec3i normal);

/// The least and the greatest dot(normal, p) of a surface's points p, for each candidate direction.
using ContourExtents = std::array<Interval, ContourCandidates::kMax>;

/// Returns the extents of a surface of at least one polygon.
ContourExtents extents_of(std::span<const PlanarPolygon> surface,
                          const ContourCandidates& candidates);

/// Returns the best contour for a surface with these extents along the candidates, or none if the
/// shape exceeds the surface along no candidate. The margin between surface and planes is larger
/// than all rounding errors here and in the ray casts.
std::optional<FittedContour> fit_contour(const ConvexPolyhedron& shape,
                                         const ContourCandidates& candidates,
                                         const ContourExtents& extents);

/// Sets `result`, another polyhedron, to the part of the shape between the contour's planes.
void clip_to_contour(const ConvexPolyhedron& shape, Contour contour, ConvexPolyhedron& result);

}  // namespace voxdag
