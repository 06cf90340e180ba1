#include "voxdag/builders/dag/ray_space.hpp"

#include <utility>

#include "voxdag/algebra/combine.hpp"
#include "voxdag/builders/dag/build_svdag.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/mesh/place_vertices.hpp"

namespace voxdag {

RaySpace ray_space(std::span<const Vec3d> origins, std::span<const Vec3d> ends,
                   const std::vector<bool>& hits, const GridRequest& request, Work work) {
  if (origins.size() != ends.size() && origins.size() != 1)
    throw Error("rays need an origin each, or one for all");
  if (!hits.empty() && hits.size() != ends.size())
    throw Error("rays need a value each that says whether they hit");
  if (ends.size() + origins.size() > UINT32_MAX) throw Error("there are more than 2^32 points");
  // A ray is a triangle without area, and its end one without length.
  Mesh mesh;
  const MemoryReservation bytes(work.memory, (ends.size() + origins.size()) * sizeof(Vec3f) +
                                                 2 * ends.size() * sizeof(Triangle));
  mesh.vertices.resize(ends.size() + origins.size());
  StoredVector<Triangle> points;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const auto end = static_cast<std::uint32_t>(i),
               origin = static_cast<std::uint32_t>(ends.size() + (origins.size() == 1 ? 0 : i));
    if (!is_finite(ends[i]) || !is_finite(origins[origins.size() == 1 ? 0 : i]))
      throw Error("ray " + std::to_string(i) + " is not finite");
    mesh.triangles.push_back({origin, end, end});
    if (hits.empty() || hits[i]) points.push_back({end, end, end});
  }
  place_vertices(
      mesh, [&](std::size_t i) { return i < ends.size() ? ends[i] : origins[i - ends.size()]; },
      work);
  RaySpace space;
  space.grid = grid_for(mesh, request);
  const BuildResult passed = build_svdag(mesh, space.grid, BuildMethod::kHashConsed, work);
  mesh.triangles = std::move(points);
  BuildResult occupied = build_svdag(mesh, space.grid, BuildMethod::kHashConsed, work);
  space.free = combine(passed.dag.view(), occupied.dag.view(), SetOperation::kDifference, work);
  space.occupied = std::move(occupied.dag);
  return space;
}

}  // namespace voxdag
