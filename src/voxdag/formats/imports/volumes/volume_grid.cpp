#include "voxdag/formats/imports/volumes/volume_grid.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

/// Spacings that differ by less are equal but for rounding.
constexpr double kSameSpacing = 1e-5;
constexpr double kMaxCoordinate = 1e30;

std::string text_of(double value) {
  char text[32];
  const auto result = std::to_chars(text, text + sizeof text, value, std::chars_format::general, 6);
  return {text, result.ptr};
}

}  // namespace

bool is_along(Vec3d direction, int axis) {
  // Allows an angle of 0.003 degrees.
  return direction[axis] >= length(direction) * (1 - 1e-9) && direction[axis] > 0;
}

Grid grid_of_volume(const std::filesystem::path& path, const VolumeSize& size,
                    const VolumePlacement& placement, std::vector<std::string>& warnings) {
  const Vec3d spacing = placement.spacing;
  for (int axis = 0; axis < 3; ++axis) {
    if (!(spacing[axis] >= 1 / kMaxCoordinate && spacing[axis] <= kMaxCoordinate))
      throw Error(path.string(), "header",
                  "the spacing of the voxels must be between 1e-30 and 1e30, not " +
                      text_of(spacing[axis]));
    if (placement.first_centre && !(std::abs((*placement.first_centre)[axis]) <= kMaxCoordinate))
      throw Error(path.string(), "header", "the volume lies beyond 1e30");
  }
  Grid grid;
  grid.levels = levels_of(size);
  const double greatest = std::max({spacing.x, spacing.y, spacing.z});
  grid.voxel_size = std::min({spacing.x, spacing.y, spacing.z});
  if (greatest <= grid.voxel_size * (1 + kSameSpacing))
    grid.voxel_size = spacing.x;
  else
    warnings.push_back("the voxels are boxes of " + text_of(spacing.x) + " x " +
                       text_of(spacing.y) + " x " + text_of(spacing.z) +
                       "; they become cubes of side " + text_of(grid.voxel_size));
  grid.quantization_scale = kSubvoxels / grid.voxel_size;
  if (placement.first_centre)
    grid.origin = *placement.first_centre - Vec3d{0.5, 0.5, 0.5} * grid.voxel_size;
  if (placement.is_turned)
    warnings.emplace_back(
        "the file turns, mirrors or shears the volume in space; its voxels are read without that");
  return grid;
}

}  // namespace voxdag
