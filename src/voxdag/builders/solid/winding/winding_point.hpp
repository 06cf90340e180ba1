#pragma once
/// The points at which winding numbers are taken, and the side of a triangle that they lie on.
#include <cmath>
#include <numbers>

#include "voxdag/builders/voxelize/grid_mapping.hpp"

namespace voxdag {

/// The solid angle of all directions.
inline constexpr double kSphere = 4 * std::numbers::pi;

/// Returns a point of a cell of 2^log2_side voxels a side, in units of 1/256 voxel. It lies a
/// little beside the centre, by less than a unit: no line between two whole units runs through it.
inline Vec3d winding_point(Vec3i cell, int log2_side) {
  const double side = std::ldexp(256.0, log2_side);
  return (static_cast<Vec3d>(cell) + Vec3d{0.5, 0.5, 0.5}) * side +
         Vec3d{0.1137418931, 0.2213370174, 0.3371905663};
}

/// The corners of a triangle, seen from a point.
struct SeenTriangle {
  Vec3d a, b, c;

  SeenTriangle(const QuantizedTriangle& t, Vec3d point)
      : a(static_cast<Vec3d>(t.x) - point),
        b(static_cast<Vec3d>(t.y) - point),
        c(static_cast<Vec3d>(t.z) - point) {}
  /// Returns six times the volume between point and triangle: positive if the corners run clockwise
  /// as seen from the point, which is then inside.
  double volume6() const { return dot(a, cross(b, c)); }
};

}  // namespace voxdag
