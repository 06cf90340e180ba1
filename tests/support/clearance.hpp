#pragma once
/// Checks that a camera keeps away from the surfaces of a scene.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "voxdag/builders/dag/build_svdag.hpp"
#include "voxdag/builders/voxelize/grid_mapping.hpp"
#include "voxdag/render/film/camera_path.hpp"
#include "voxdag/trace/cast.hpp"
#include "voxdag/trace/svdag_nodes.hpp"

namespace voxdag {

/// Returns the distance from `eye` to the nearest surface in many directions.
inline double nearest(const SvdagNodes& nodes, const Grid& grid, Vec3d eye) {
  constexpr int kDirections = 600;
  double least = HUGE_VAL;
  for (int i = 0; i < kDirections; ++i) {  // a spiral around the sphere
    const double z = 1 - (2 * i + 1.0) / kDirections, turn = i * 2.399963229728653;
    const double r = std::sqrt(1 - z * z);
    const Vec3d direction{r * std::cos(turn), r * std::sin(turn), z};
    const GridRay ray = make_grid_ray(grid, eye, direction, 0, HUGE_VAL);
    CellHit cell;
    if (cast(nodes, ray, StopAtVoxels{}, cell))
      least = std::min(least, ray.to_world_t(static_cast<double>(cell.t)));
  }
  return least;
}

/// Expects that at every tenth of a second the camera is at least `clearance` away from the voxels
/// of the mesh at 512³, and that its target is at least `ahead` away. Lengths are in world units.
inline void expect_clear_path(const CameraPath& path, const Mesh& mesh, double clearance,
                              double ahead) {
  const Grid grid = fit_grid(mesh, 9);
  const Svdag dag = build_svdag(mesh, grid).dag;
  const SvdagNodes nodes(dag.view());
  for (double time = path.start(); time <= path.end(); time += 0.1) {
    const View view = path.at(time);
    EXPECT_GE(nearest(nodes, grid, view.eye), clearance)
        << "at " << time << " s: " << view.eye.x << "," << view.eye.y << "," << view.eye.z;
    const Vec3d forward = view.target - view.eye;
    EXPECT_GE(std::sqrt(dot(forward, forward)), ahead) << "at " << time << " s";
  }
}

}  // namespace voxdag
