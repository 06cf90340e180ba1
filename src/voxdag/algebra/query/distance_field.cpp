#include "voxdag/algebra/query/distance_field.hpp"

#include <cmath>

#include "voxdag/algebra/query/nearest_voxel.hpp"
#include "voxdag/core/parallel/polled_for.hpp"

namespace voxdag {

std::vector<float> distance_field(const SvdagView& dag, const Box3i& box, Work work) {
  const Vec3i size = box.hi - box.lo;
  const auto row = static_cast<std::size_t>(size.x);
  const std::size_t rows = static_cast<std::size_t>(size.y) * static_cast<std::size_t>(size.z);
  std::vector<float> distances(row * rows);
  polled_for(rows, 1, work, "distances", [&](std::size_t i) {
    const auto y = box.lo.y + static_cast<std::int32_t>(i % static_cast<std::size_t>(size.y));
    const auto z = box.lo.z + static_cast<std::int32_t>(i / static_cast<std::size_t>(size.y));
    double most = HUGE_VAL;
    for (std::size_t x = 0; x < row; ++x) {
      const Vec3d centre =
          Vec3d{box.lo.x + static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)} +
          Vec3d{0.5, 0.5, 0.5};
      const auto nearest = nearest_voxel(dag, centre, most * most);
      const double distance = nearest ? std::sqrt(nearest->distance2) : HUGE_VAL;
      distances[i * row + x] = static_cast<float>(distance);
      // The next place is one voxel farther from there at most; the rest is for rounding.
      most = (distance + 1) * (1 + 1e-9);
    }
  });
  return distances;
}

}  // namespace voxdag
