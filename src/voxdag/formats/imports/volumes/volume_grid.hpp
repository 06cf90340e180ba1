#pragma once
/// Where a volume lies in the world.
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "voxdag/formats/imports/volumes/dense_volume.hpp"

namespace voxdag {

/// The place of a volume in world units, as its header gives it.
struct VolumePlacement {
  /// From the centre of a voxel to that of the next one, along x, y and z of the volume.
  std::array<Vec3d, 3> steps{Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}};
  std::optional<Vec3d> first_centre;  ///< Of voxel (0, 0, 0); without it, its corner is at 0.
  bool is_curved = false;             ///< The steps change from place to place.
  bool is_known = false;              ///< The header names a place or a spacing.
};

/// Returns the grid of voxels of side 1 that begins at `lo` and holds the voxels [lo, hi), at least
/// one. Throws Error if a side of them is longer than 1,048,576.
Grid grid_of_scene(const std::filesystem::path& path, Vec3l lo, Vec3l hi);

/// Maps the voxels of a volume to those of a grid, which are cubes along the axes of the world.
/// Axes that point along other axes of the world, or against them, are followed exactly. A voxel
/// that is a box becomes the cubes whose centres lie in it; their side is the least one of the box.
class VolumeMap {
 public:
  /// The voxels are those of the grid.
  explicit VolumeMap(const Grid& grid = {}) : grid_(grid) {}
  /// Adds a warning if the voxels are no cubes, or the axes are turned otherwise: then those of the
  /// world that are nearest take their places. Throws Error for steps whose length is not between
  /// 1e-30 and 1e30, a place beyond 1e30, more than 4096 cubes for a voxel, and more cubes a side
  /// than a grid can have.
  VolumeMap(const std::filesystem::path& path, const VolumeSize& size,
            const VolumePlacement& placement, std::vector<std::string>& warnings);

  const Grid& grid() const { return grid_; }
  /// Passes the cubes of some voxels to `visit`.
  void visit_cubes(const VoxelBatch& voxels, const VisitBatch& visit) const;

 private:
  /// An axis of the volume, and the axis of the world along which it lies.
  struct Axis {
    int world = 0;
    bool is_mirrored = false;
    double voxels = 0, cubes_per_voxel = 1;

    /// Returns the index of the first cube after `count` voxels: its centre lies behind them.
    double first_cube(double count) const;
  };

  Grid grid_;
  std::array<Axis, 3> axes_;
  bool is_identity_ = true;
};

}  // namespace voxdag
