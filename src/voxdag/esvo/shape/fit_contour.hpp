#pragma once
/// The contour that takes away most of what a voxel's shape has beyond its surface.
///
/// Source: Laine and Karras, "Efficient Sparse Voxel Octrees", I3D 2010, section 3.4: of some
/// candidate directions, the one in which the shape's extent exceeds the surface's most; planes
/// across it as near to the surface as they can be stored, never nearer.
#include <array>
#include <cmath>
#include <optional>
#include <span>

#include "voxdag/core/interval.hpp"
#include "voxdag/esvo/shape/convex_polyhedron.hpp"
#include "voxdag/esvo/shape/near_surface.hpp"
#include "voxdag/layout/contour.hpp"

namespace voxdag {

/// A direction as contours store it.
struct ContourDirection {
  Vec3i normal{};
  float length = 0;  ///< Of `normal`; 0 if there is no direction.

  ContourDirection() = default;
  explicit ContourDirection(Vec3i n)
      : normal(n), length(std::sqrt(static_cast<float>(dot(n, n)))) {}

  /// The one nearest to `direction` or its opposite, whichever points up; none for zero.
  static ContourDirection nearest(Vec3d direction);

  bool exists() const { return length > 0; }
};

/// Directions to choose from, a few that differ well.
class ContourCandidates {
 public:
  static constexpr int kMost = 8;

  /// Adds a direction unless one like it (or its opposite) is there, or adds to that one's weight.
  /// Where there is no room the lightest goes.
  void add(const ContourDirection& direction, double weight);

  std::span<const ContourDirection> directions() const { return {directions_.data(), count_}; }

 private:
  std::size_t count_ = 0;
  std::array<ContourDirection, kMost> directions_;
  std::array<double, kMost> weights_;
};

struct FittedContour {
  Contour contour;
  /// By how much the shape becomes thinner across it, in the voxel's coordinates: its side is 2.
  double gain = 0;

  /// A contour that saves less does not pay for its four bytes, unless it lets the subdivision end
  /// here, where each child would have to have one of its own.
  static constexpr double kLeastGain = 0.15;
  bool pays() const { return gain > kLeastGain; }
};

/// The least and the greatest dot(normal, p) of the shape's points p.
Interval extent_of(const ConvexPolyhedron& shape, Vec3i normal);

/// The least and the greatest dot(normal, p) of some points p, by direction.
using ContourExtents = std::array<Interval, ContourCandidates::kMost>;

/// Those of a surface of one polygon at least.
ContourExtents extents_of(std::span<const PlanarPolygon> surface,
                          const ContourCandidates& candidates);

/// The best contour, or none if the shape nowhere exceeds the surface, whose extents along the
/// candidates are given. The surface lies between the planes by a margin that exceeds all rounding
/// here and in the ray casts.
std::optional<FittedContour> fit_contour(const ConvexPolyhedron& shape,
                                         const ContourCandidates& candidates,
                                         const ContourExtents& extents);

/// Of the shape what is between the contour's planes. `result` is another one.
void clip_to_contour(const ConvexPolyhedron& shape, Contour contour, ConvexPolyhedron& result);

}  // namespace voxdag
