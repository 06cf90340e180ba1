#include "voxdag/algebra/query/nearest_voxel.hpp"

#include <algorithm>

#include "voxdag/algebra/contact/core_distance.hpp"
#include "voxdag/algebra/contact/least_cell.hpp"
#include "voxdag/core/vec.hpp"
#include "voxdag/stored/svdag/svdag_lookup.hpp"

namespace voxdag {

std::optional<NearestVoxel> nearest_voxel(const SvdagView& dag, Vec3d point, double most2) {
  if (dag.is_empty() || !(most2 >= 0) || !std::isfinite(dot(point, point))) return std::nullopt;
  const double side = std::ldexp(1.0, dag.levels);
  if (std::min({point.x, point.y, point.z}) >= 0 && std::max({point.x, point.y, point.z}) < side) {
    const Vec3i voxel{static_cast<std::int32_t>(point.x), static_cast<std::int32_t>(point.y),
                      static_cast<std::int32_t>(point.z)};
    if (svdag_contains(dag, voxel, dag.levels)) return NearestVoxel{voxel, 0};
  }
  const SquaredPointDistance cost(point);
  const LeastCell<CellKind::kVoxels, Ties::kFirst, SquaredPointDistance> found(dag, cost, most2);
  if (!found.is_found()) return std::nullopt;
  return NearestVoxel{found.first(), found.cost()};
}

}  // namespace voxdag
