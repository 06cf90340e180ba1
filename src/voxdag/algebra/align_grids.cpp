#include "voxdag/algebra/align_grids.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

constexpr double kTolerance = 1e-3;  // voxels

std::string text_of(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

}  // namespace

AlignedGrids align_grids(const Grid& first, const Grid& second) {
  const double side = static_cast<double>(std::max(first.resolution(), second.resolution()));
  if (!(std::fabs(second.voxel_size / first.voxel_size - 1) * side < kTolerance))
    throw Error("the grids do not align: their voxels have sides of " + text_of(first.voxel_size) +
                " and " + text_of(second.voxel_size));
  const Vec3d place = first.to_grid(second.origin);
  AlignedGrids result{first, {}, {}};
  std::int64_t extent = first.resolution();
  bool is_inside = true;
  for (int axis = 0; axis < 3; ++axis) {
    const double nearest = std::nearbyint(place[axis]);
    if (!(std::fabs(place[axis]) < 0x1p30))
      throw Error("the grids do not align: they are too far apart for a common grid");
    if (!(std::fabs(place[axis] - nearest) < kTolerance))
      throw Error(std::string("the grids do not align: along ") + "xyz"[axis] +
                  " they are a part of a voxel apart, " + text_of(place[axis] - nearest));
    const auto offset = static_cast<std::int32_t>(nearest);
    result.first[axis] = std::max(-offset, 0);
    result.second[axis] = std::max(offset, 0);
    extent = std::max({extent, result.first[axis] + first.resolution(),
                       result.second[axis] + second.resolution()});
    is_inside &= offset >= 0 && offset + second.resolution() <= first.resolution();
  }
  if (is_inside) return result;
  while (result.grid.resolution() < extent) {
    if (++result.grid.levels > kMaxLevels)
      throw Error("the grids are too far apart: a grid that holds both would have more than " +
                  std::to_string(std::int64_t{1} << kMaxLevels) + " voxels a side");
  }
  const Vec3i moved = result.first;
  result.grid.origin = first.to_world({-static_cast<double>(moved.x), -static_cast<double>(moved.y),
                                       -static_cast<double>(moved.z)});
  return result;
}

}  // namespace voxdag
