#include "voxdag/builders/solid/winding/winding_field.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>

#include "voxdag/builders/solid/ray_bins.hpp"
#include "voxdag/builders/solid/winding/boundary_caps.hpp"
#include "voxdag/builders/solid/winding/winding_point.hpp"
#include "voxdag/core/morton.hpp"
#include "voxdag/core/parallel/polled_for.hpp"
#include "voxdag/stored/svdag/svdag_lookup.hpp"

namespace voxdag {
namespace {

/// Returns on which side of the line from a to b the ray at p passes in the plane of y and z: 1 or
/// -1; 0 if a and b have the same y and z. The line from b to a gives exactly the opposite.
int side_of_edge(Vec3i a, Vec3i b, const Vec3d& p) {
  if (is_before(b, a)) return -side_of_edge(b, a, p);
  const double side =
      static_cast<double>(b.y - a.y) * (p.z - a.z) - static_cast<double>(b.z - a.z) * (p.y - a.y);
  return (side > 0) - (side < 0);
}

/// Returns 1 or -1 if the ray from p along +x crosses the triangle, else 0.
int crossing(const QuantizedTriangle& t, const Vec3d& p) {
  const int side = side_of_edge(t.x, t.y, p);
  if (side == 0 || side_of_edge(t.y, t.z, p) != side || side_of_edge(t.z, t.x, p) != side) return 0;
  return side * SeenTriangle(t, p).volume6() > 0 ? side : 0;
}

/// Counts for each voxel the crossings of the ray from its point (winding_point.hpp) along +x:
/// those to the side from which a triangle's corners run counter-clockwise, less those from it. The
/// winding number of a closed surface is the sum over its triangles.
class CrossingCounter {
 public:
  /// There must be voxels, which must outlive this object. Counts 8 bytes for each in `memory`.
  /// Throws OverMemory.
  CrossingCounter(std::span<const Vec3i> voxels, MemoryBudget* memory)
      : voxels_(voxels), bins_(voxels, memory), crossings_(voxels.size(), 0, memory) {}

  /// Adds `times` the crossings of the triangle. Thread-safe.
  void add(const QuantizedTriangle& triangle, std::int32_t times) {
    bins_.each_behind(triangle, [&](std::uint32_t i) {
      const int count = crossing(triangle, winding_point(voxels_[i], 0));
      if (count != 0)
        std::atomic_ref(crossings_[i]).fetch_add(times * count, std::memory_order_relaxed);
    });
  }
  std::int32_t crossings(std::size_t voxel) const { return crossings_[voxel]; }

 private:
  std::span<const Vec3i> voxels_;
  RayBins bins_;
  CountedVector<std::int32_t> crossings_;
};

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

PageVector<std::uint64_t> find_sheets(const WindingField& field, const SvdagView& cover,
                                      Work work) {
  constexpr std::size_t kChunk = 256;
  // The cells of a level in which the inside may end, in Morton order.
  PageVector<std::uint64_t> cells(work.memory);
  cells.push_back(0);
  for (int level = 0; level <= cover.levels; ++level) {
    const int log2_side = cover.levels - level;
    PageVector<std::uint8_t> may_differ(work.memory);
    may_differ.resize(cells.size());
    polled_for((cells.size() + kChunk - 1) / kChunk, 1, work, "holes", [&](std::size_t chunk) {
      for (std::size_t i = chunk * kChunk; i < std::min(cells.size(), (chunk + 1) * kChunk); ++i) {
        const Vec3i cell = morton_decode(cells[i]);
        const bool is_set = log2_side == 0 && svdag_contains(cover, cell, cover.levels);
        may_differ[i] = !is_set && field.may_differ(cell, log2_side) ? 1 : 0;
      }
    });
    PageVector<std::uint64_t> next(work.memory);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (may_differ[i] == 0) continue;
      if (log2_side == 0) next.push_back(cells[i]);
      for (std::uint64_t child = 0; log2_side > 0 && child < 8; ++child)
        next.push_back(cells[i] << 3 | child);
    }
    cells = std::move(next);
  }
  return cells;
}

}  // namespace voxdag
