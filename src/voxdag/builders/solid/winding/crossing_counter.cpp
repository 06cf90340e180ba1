#include "voxdag/builders/solid/winding/crossing_counter.hpp"

#include <atomic>

#include "voxdag/builders/solid/winding/winding_point.hpp"
#include "voxdag/core/vec_order.hpp"

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

}  // namespace

CrossingCounter::CrossingCounter(std::span<const Vec3i> voxels, MemoryBudget* memory)
    : voxels_(voxels), bins_(voxels, memory), crossings_(voxels.size(), 0, memory) {}

void CrossingCounter::add(const QuantizedTriangle& triangle, std::int32_t times) {
  bins_.each_behind(triangle, [&](std::uint32_t i) {
    const int count = crossing(triangle, winding_point(voxels_[i], 0));
    if (count != 0)
      std::atomic_ref(crossings_[i]).fetch_add(times * count, std::memory_order_relaxed);
  });
}

}  // namespace voxdag
