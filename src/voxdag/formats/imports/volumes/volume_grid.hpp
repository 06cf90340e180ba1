#pragma once
/// Where a volume lies in the world.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "voxdag/formats/imports/volumes/dense_volume.hpp"

namespace voxdag {

/// The place of a volume in world units, as its header gives it.
struct VolumePlacement {
  Vec3d spacing{1, 1, 1};             ///< Between the centres of voxels, along x, y and z.
  std::optional<Vec3d> first_centre;  ///< Of voxel (0, 0, 0); without it, its corner is at 0.
  bool is_turned = false;             ///< The axes are not those of the world.
};

/// Returns whether a direction is that of the axis, but for rounding.
bool is_along(Vec3d direction, int axis);

/// Returns the grid of a volume. Voxels are cubes of the smallest spacing. Adds a warning if the
/// file has other voxels, or turned ones. Throws Error for a spacing that is not between 1e-30 and
/// 1e30, and for a place beyond 1e30.
Grid grid_of_volume(const std::filesystem::path& path, const VolumeSize& size,
                    const VolumePlacement& placement, std::vector<std::string>& warnings);

}  // namespace voxdag
