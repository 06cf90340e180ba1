#include "voxdag/builders/voxelize/grid_request.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "voxdag/builders/voxelize/grid_mapping.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/mesh/mesh_bounds.hpp"

namespace voxdag {
namespace {

/// Returns the greatest multiple of `size` that is not above `x`. A quotient within its rounding
/// errors of a whole number counts as whole: 0.3 is a multiple of 0.1.
double multiple_below(double x, double size) {
  const double at = x / size, whole = std::nearbyint(at);
  return (std::abs(at - whole) <= 4 * 0x1p-53 * std::abs(at) ? whole : std::floor(at)) * size;
}

/// Returns how many voxels the box takes along each axis, from its lower corner on. Vertices lie on
/// units of 1/256 voxel; only those of a mesh (not of bounds) on the upper side take a voxel there.
Vec3l used_voxels(const Grid& grid, const Box3d& box, bool has_upper_sides) {
  Vec3l used;
  for (int axis = 0; axis < 3; ++axis) {
    const double units = std::round((box.hi[axis] - box.lo[axis]) * grid.quantization_scale);
    used[axis] =
        static_cast<std::int64_t>(std::floor((units + (has_upper_sides ? 0 : -1)) / 256)) + 1;
    used[axis] = std::max<std::int64_t>(used[axis], 1);
  }
  return used;
}

/// Returns the box of step 1; an empty one if the mesh has no triangles.
Box3d box_of(const Box3d& mesh_bounds, const GridRequest& request) {
  Box3d box = request.bounds.value_or(mesh_bounds);
  if (box.is_empty()) return box;
  for (int axis = 0; axis < 3; ++axis) {
    double& lo = box.lo[axis];
    if (request.origin) lo = (*request.origin)[axis];
    if (box.hi[axis] < lo) throw Error("all of the input lies below the origin of the grid");
    if (request.snap && request.voxel_size) lo = multiple_below(lo, *request.voxel_size);
    box.hi[axis] = std::max(box.hi[axis], lo);
  }
  return box;
}

}  // namespace

Grid grid_for(const Mesh& mesh, const GridRequest& request) {
  return grid_for(request.bounds ? Box3d::empty() : referenced_bounds(mesh), request);
}

Grid grid_for(const Box3d& mesh_bounds, const GridRequest& request) {
  const Box3d box = box_of(mesh_bounds, request);
  Grid grid;
  if (request.resolution) {
    const std::int64_t inner = *request.resolution - 2 * request.padding;
    if (inner < 1)
      throw Error("a padding of " + std::to_string(request.padding) +
                  " voxels on each side leaves none of " + std::to_string(*request.resolution));
    grid = request.bounds ? divide_bounds(box, inner) : fit_voxels(box, inner);
  } else {
    grid = request.bounds ? grid_from_bounds(box, *request.voxel_size)
                          : grid_from_voxel_size(box, *request.voxel_size);
  }
  return with_margins(grid, used_voxels(grid, box, !request.bounds), request);
}

Grid with_margins(Grid grid, Vec3l used, const GridRequest& request) {
  if (request.padding == 0 && !request.center) return grid;
  Vec3d shift{};
  const std::int64_t longest = std::max({used.x, used.y, used.z}) + 2 * request.padding;
  while (grid.resolution() < longest)
    if (++grid.levels > kMaxLevels)
      throw Error("with its padding, the grid would have more than 2^" +
                  std::to_string(kMaxLevels) + " voxels a side");
  for (int axis = 0; axis < 3; ++axis) {
    const std::int64_t middle = (grid.resolution() - used[axis]) / 2;
    shift[axis] = static_cast<double>(request.center ? middle : request.padding);
  }
  grid.origin = grid.origin - shift * grid.voxel_size;
  if (request.snap)
    for (int axis = 0; axis < 3; ++axis)
      grid.origin[axis] = std::nearbyint(grid.origin[axis] / grid.voxel_size) * grid.voxel_size;
  return grid;
}

std::map<std::string, std::string> settings_of(const GridRequest& request) {
  std::map<std::string, std::string> settings = {
      {"cover", "exact"},
      {"grid_from", request.bounds   ? "bounds"
                    : request.origin ? "origin"
                                     : "mesh"},
      {"scale_from", request.resolution ? "resolution" : "voxel_size"}};
  const std::int64_t n = request.resolution.value_or(1 << kMinLevels);
  if (n < 1 << kMinLevels || !std::has_single_bit(static_cast<std::uint64_t>(n)))
    settings["resolution"] = std::to_string(n);
  if (request.snap) settings["snap"] = "yes";
  if (request.padding != 0) settings["padding"] = std::to_string(request.padding);
  if (request.center) settings["center"] = "yes";
  return settings;
}

}  // namespace voxdag
