#pragma once
/// Finds the voxels that points lie in.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "voxdag/core/grid.hpp"
#include "voxdag/core/vec.hpp"

namespace voxdag {

/// Bounds the error of coordinates: doubles and floats round the decimal numbers that people mean,
/// such as 0.3.
struct CoordinateError {
  double relative = 0x1p-53;  ///< Of a coordinate: half a unit in its last place.
  Vec3d absolute{};           ///< In addition, in world units.
};
inline constexpr CoordinateError kFloatCoordinates{0x1p-24, {}};

/// Finds the voxel of a point. A point on a plane between two voxels belongs to the upper one. A
/// coordinate lies on a plane, too, if it is nearer to it than four times the rounding errors of
/// its own, the origin and the quotient; at most 1/64 voxel. So points that are 0.1 apart set a
/// voxel each if voxels are 0.1 wide, wherever the grid begins.
class PointLocator {
 public:
  PointLocator(const Grid& grid, const CoordinateError& error)
      : origin_(grid.origin),
        size_(grid.voxel_size),
        side_(std::ldexp(1.0, grid.levels)),
        relative_(4 * error.relative / size_) {
    for (int axis = 0; axis < 3; ++axis)
      base_[axis] =
          4 * (error.absolute[axis] + kEpsilon * std::abs(grid.origin[axis])) / grid.voxel_size;
  }

  /// Returns the voxel's coordinate on an axis as a whole number, also beyond the grid.
  double index(double coordinate, int axis) const {
    const double at = (coordinate - origin_[axis]) / size_;
    const double plane = std::nearbyint(at);
    const double tolerance =
        base_[axis] + relative_ * std::abs(coordinate) + 4 * kEpsilon * std::abs(at);
    return std::abs(at - plane) <= std::min(tolerance, kMaxTolerance) ? plane : std::floor(at);
  }

  /// Returns the voxel of a finite point; none if it lies outside of the grid.
  std::optional<Vec3i> voxel(Vec3d point) const {
    Vec3i voxel;
    for (int axis = 0; axis < 3; ++axis) {
      const double at = index(point[axis], axis);
      if (!(at >= 0 && at < side_)) return std::nullopt;
      voxel[axis] = static_cast<std::int32_t>(at);
    }
    return voxel;
  }

  /// Returns the voxel of a point within the box that the grid was made for: points on its upper
  /// sides belong to the last voxels.
  Vec3i voxel_in_box(Vec3d point) const {
    Vec3i voxel;
    for (int axis = 0; axis < 3; ++axis)
      voxel[axis] = static_cast<std::int32_t>(std::clamp(index(point[axis], axis), 0.0, side_ - 1));
    return voxel;
  }

 private:
  static constexpr double kEpsilon = 0x1p-53, kMaxTolerance = 0x1p-6;

  Vec3d origin_, base_;
  double size_, side_, relative_;
};

}  // namespace voxdag
