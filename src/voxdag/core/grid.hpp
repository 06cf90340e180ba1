#pragma once
/// Placement of the voxel grid in the world.
#include "voxdag/core/box.hpp"
#include "voxdag/core/vec.hpp"

namespace voxdag {

inline constexpr int kSubvoxels = 256;  ///< Mesh vertices are rounded to 1/256 voxel.
inline constexpr int kMinLevels = 2;    ///< 4³ voxels: one leaf block.
inline constexpr int kMaxLevels = 20;   ///< 1,048,576³ voxels.

/// A grid of N³ voxels, N = 2^levels. Voxel (i,j,k) is a half-open cube of side voxel_size. Its
/// lower corner is at origin + (i,j,k) * voxel_size, in world units.
struct Grid {
  int levels = kMinLevels;
  Vec3d origin{};
  double voxel_size = 1;
  /// The factor that quantises vertices, in 1/256 voxel per world unit. Stored beside voxel_size,
  /// because rounding makes it impossible to compute one exactly from the other.
  double quantization_scale = kSubvoxels / voxel_size;

  /// Returns N, the number of voxels along a side.
  VOXDAG_HD constexpr std::int64_t resolution() const { return std::int64_t{1} << levels; }
  /// Returns the side of a cell of `level` (0..levels), in world units.
  VOXDAG_HD constexpr double cell_size(int level) const {
    return voxel_size * static_cast<double>(std::int64_t{1} << (levels - level));
  }
  /// Returns the side of the whole grid, in world units.
  VOXDAG_HD constexpr double side() const { return cell_size(0); }
  /// Returns a world position in voxel units; voxel (0,0,0) starts at 0.
  VOXDAG_HD constexpr Vec3d to_grid(Vec3d world) const {
    return (world - origin) * (1.0 / voxel_size);
  }
  /// Returns the world position of a position in voxel units.
  VOXDAG_HD constexpr Vec3d to_world(Vec3d grid) const { return origin + grid * voxel_size; }
  /// Returns the grid's cube, in world units.
  constexpr Box3d bounds() const {
    const double n = static_cast<double>(resolution());
    return {origin, to_world({n, n, n})};
  }
  friend bool operator==(const Grid&, const Grid&) = default;
};

}  // namespace voxdag
