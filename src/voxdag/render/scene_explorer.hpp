#pragma once
/// Tools to choose views of a scene: directions relative to its up vector, and distances in it.
#include <cmath>

#include "voxdag/core/grid.hpp"
#include "voxdag/stored/svdag/voxel_set.hpp"
#include "voxdag/trace/stop_below_size.hpp"
#include "voxdag/trace/visit_nodes.hpp"

namespace voxdag {

/// A right-handed frame of unit vectors: east, north, up.
struct Compass {
  Vec3d east, north, up;

  explicit Compass(Vec3d upwards) : up(normalized(upwards)) {
    const Vec3d reference = std::fabs(up.x) < 0.9 ? Vec3d{1, 0, 0} : Vec3d{0, 0, 1};
    north = normalized(cross(up, reference));
    east = cross(north, up);
  }
  /// Returns the unit vector at these angles, in radians.
  Vec3d direction(double yaw, double pitch) const {
    return (east * std::cos(yaw) + north * std::sin(yaw)) * std::cos(pitch) + up * std::sin(pitch);
  }
};

/// Casts rays at the level of detail that suffices to choose a view.
class SceneExplorer {
 public:
  SceneExplorer(const VoxelSet& voxels, const Grid& grid)
      : voxels_(voxels), grid_(grid), stop_{std::ldexp(1.0f, -9), 0, 2} {}

  /// Returns the distance in world units at which a unit direction hits anything; +infinity if it
  /// hits nothing.
  double distance(Vec3d from, Vec3d direction) const {
    const GridRay ray = make_grid_ray(grid_, from, direction, 0, HUGE_VAL);
    CellHit cell;
    if (!visit_nodes(voxels_, [&](const auto& nodes) { return cast(nodes, ray, stop_, cell); }))
      return HUGE_VAL;
    return ray.to_world_t(static_cast<double>(cell.t));
  }

 private:
  VoxelSet voxels_;
  Grid grid_;
  StopBelowSize stop_;
};

/// Returns direction `i` of `count`, evenly distributed over the sphere: a Fibonacci spiral.
inline Vec3d sphere_direction(const Compass& compass, int i, int count) {
  constexpr double kGoldenAngle = 2.399963229728653;
  return compass.direction(i * kGoldenAngle, std::asin(1 - 2 * (i + 0.5) / count));
}

}  // namespace voxdag
