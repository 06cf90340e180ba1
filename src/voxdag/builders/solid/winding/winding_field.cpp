#include "voxdag/builders/solid/winding/winding_field.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "voxdag/builders/solid/winding/boundary_caps.hpp"
#include "voxdag/builders/solid/winding/crossing_counter.hpp"
#include "voxdag/builders/solid/winding/winding_point.hpp"
#include "voxdag/core/parallel/polled_for.hpp"

namespace voxdag {
namespace {

/// Returns the distance between two numbers on a circle of length 1.
double distance_around(double a, double b) {
  const double d = a - b;
  return std::abs(d - std::round(d));
}

/// The error of a winding number that is as good as none.
constexpr double kFinest = 1e-9;

/// Calls add(i) for all i below `count` on many threads.
template <class Add>
void add_all(std::size_t count, Work work, const Add& add) {
  constexpr std::size_t kChunk = 1024;
  polled_for((count + kChunk - 1) / kChunk, 1, work, "inside", [&](std::size_t chunk) {
    for (std::size_t i = chunk * kChunk; i < std::min(count, (chunk + 1) * kChunk); ++i) add(i);
  });
}

}  // namespace

WindingField::WindingField(const QuantizedMesh& mesh, CountedVector<BoundaryEdge> boundary,
                           double threshold, Work work)
    : mesh_(mesh),
      edges_(boundary, work),
      caps_(cap_boundary(std::move(boundary), work), work),
      threshold_(threshold) {}

std::vector<bool> WindingField::are_inside(std::span<const Vec3i> voxels, Work work) const {
  if (voxels.empty()) return {};
  CrossingCounter closed(voxels, work.memory);
  add_all(mesh_.triangle_count(), work, [&](std::size_t i) { closed.add(mesh_.triangle(i), 1); });
  const PageVector<QuantizedTriangle>& caps = caps_.triangles();
  add_all(caps.size(), work, [&](std::size_t i) { closed.add(caps[i], -1); });
  CountedVector<std::uint8_t> inside(voxels.size(), 0, work.memory);
  add_all(voxels.size(), work, [&](std::size_t i) {
    inside[i] = is_inside(winding_point(voxels[i], 0), closed.crossings(i)) ? 1 : 0;
  });
  return {inside.begin(), inside.end()};
}

/// `of_closed` is the winding number of the mesh and the caps, turned over.
bool WindingField::is_inside(Vec3d point, std::int32_t of_closed) const {
  for (double tolerance = 1e-2;; tolerance *= 0.1) {
    const WindingValue caps = caps_.around(point, tolerance);
    const double winding = std::abs(of_closed + caps.value);
    if (std::abs(winding - threshold_) > caps.error || tolerance <= kFinest)
      return winding >= threshold_;
  }
}

bool WindingField::may_differ(Vec3i cell, int log2_side) const {
  if (edges_.is_empty()) return false;
  const Vec3d centre = winding_point(cell, log2_side);
  const double radius = std::ldexp(256.0, log2_side) * 0.8660254038 + 1;
  // Winding numbers that are farther apart than half a turn cannot be told apart on the circle.
  const double enough = 0.5 / radius;
  const double steepest = edges_.steepest(centre, radius, enough);
  if (!(steepest < enough)) return true;
  const double change = steepest * radius;
  const WindingValue caps = caps_.around(centre, std::max(change / 4, kFinest));
  const double nearest =
      std::min(distance_around(caps.value, threshold_), distance_around(caps.value, -threshold_));
  return nearest <= change + caps.error + kFinest;
}

}  // namespace voxdag
