#include "voxdag/solid/winding/winding_field.hpp"

#include <algorithm>
#include <cmath>

#include "voxdag/parallel/polled_for.hpp"
#include "voxdag/solid/winding/boundary_caps.hpp"

namespace voxdag {
namespace {

constexpr double kUnits = 256;  // of a voxel, in each direction

/// Points are taken a little beside the centres of cells, less than a unit: no edge of a cap, whose
/// ends are whole units, runs through such a point.
constexpr Vec3d kBeside{0.1137418931, 0.2213370174, 0.3371905663};

/// Returns the distance between two numbers on a circle of length 1.
double distance_around(double a, double b) {
  const double d = a - b;
  return std::abs(d - std::round(d));
}

PageVector<QuantizedTriangle> triangles_of(const QuantizedMesh& mesh, MemoryBudget* memory,
                                           Progress* progress) {
  PageVector<QuantizedTriangle> triangles(memory);
  triangles.reserve(mesh.triangle_count());
  for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
    poll_seldom(progress, i);
    const QuantizedTriangle t = mesh.triangle(i);
    // Triangles without area have no solid angle.
    if (cross(static_cast<Vec3d>(t.y - t.x), static_cast<Vec3d>(t.z - t.x)) != Vec3d{})
      triangles.push_back(t);
  }
  return triangles;
}

}  // namespace

WindingField::WindingField(const QuantizedMesh& mesh, CountedVector<BoundaryEdge> boundary,
                           double threshold, MemoryBudget* memory, Progress* progress)
    : edges_(boundary, memory, progress),
      mesh_(triangles_of(mesh, memory, progress), memory, progress),
      caps_(cap_boundary(std::move(boundary), memory, progress), memory, progress),
      threshold_(threshold) {}

bool WindingField::is_inside(Vec3i voxel) const {
  // The mesh tells the whole number that is nearest, and the caps the rest.
  constexpr double kRough = 0.25, kFinest = 1e-7;
  const Vec3d point = (static_cast<Vec3d>(voxel) + Vec3d{0.5, 0.5, 0.5}) * kUnits + kBeside;
  const double rough = mesh_.around(point, kRough).value;
  for (double tolerance = 1e-2;; tolerance *= 0.1) {
    const WindingValue caps = caps_.around(point, tolerance);
    const double winding = std::abs(caps.value + std::round(rough - caps.value));
    if (std::abs(winding - threshold_) > caps.error || tolerance <= kFinest)
      return winding >= threshold_;
  }
}

bool WindingField::may_differ(Vec3i cell, int log2_side) const {
  if (edges_.is_empty()) return false;
  const double side = std::ldexp(kUnits, log2_side);
  const Vec3d centre = (static_cast<Vec3d>(cell) + Vec3d{0.5, 0.5, 0.5}) * side + kBeside;
  const double radius = side * 0.8660254038 + 1;
  // Winding numbers that are farther apart than half a turn cannot be told apart on the circle.
  const double enough = 0.5 / radius;
  const double steepest = edges_.steepest(centre, radius, enough);
  if (!(steepest < enough)) return true;
  const double change = steepest * radius;
  const WindingValue caps = caps_.around(centre, std::max(change / 4, 1e-7));
  const double nearest =
      std::min(distance_around(caps.value, threshold_), distance_around(caps.value, -threshold_));
  return nearest <= change + caps.error + 1e-9;
}

}  // namespace voxdag
