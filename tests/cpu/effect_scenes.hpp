#pragma once
/// Scenes, lights and views for tests of the effects of pictures.
#include <cmath>
#include <numbers>
#include <random>

#include "support/brute_svdag.hpp"
#include "voxdag/cpu/render_image.hpp"

namespace voxdag {

inline constexpr double kPi = std::numbers::pi;

/// Returns a grid of 2^levels voxels a side over [-1,1]³.
inline Grid test_grid(int levels) {
  Grid grid;
  grid.levels = levels;
  grid.origin = {-1, -1, -1};
  grid.voxel_size = std::ldexp(2.0, -levels);
  return grid;
}

/// Returns a DAG of the voxels (x,y,z) of a grid of 2^levels for which keep(x,y,z) is true.
template <class Keep>
Svdag dag_where(int levels, const Keep& keep) {
  std::vector<Vec3i> voxels;
  const std::int32_t n = 1 << levels;
  for (std::int32_t z = 0; z < n; ++z)
    for (std::int32_t y = 0; y < n; ++y)
      for (std::int32_t x = 0; x < n; ++x)
        if (keep(x, y, z)) voxels.push_back({x, y, z});
  return brute_svdag(levels, voxels);
}

/// Returns blocks, a shell and dust on a floor.
inline Svdag mixed_scene(int levels, unsigned seed) {
  std::mt19937 rng(seed);
  const double n = 1 << levels;
  return dag_where(levels, [&](int x, int y, int z) {
    const double dx = x / n - 0.5, dy = y / n - 0.5, dz = z / n - 0.4;
    const double r = std::sqrt(dx * dx + dy * dy + dz * dz);
    const bool is_pillar = (x * 4 / (1 << levels)) % 2 == 1 && std::fabs(dz - 0.35) < 0.05;
    return y < 2 || std::fabs(r - 0.22) < 0.9 / n || (is_pillar && y < 0.7 * n) || rng() % 900 == 0;
  });
}

inline LightSpec sphere_light(Vec3d position, double radius) {
  LightSpec light;
  light.position = position;
  light.radius = radius;
  return light;
}

inline LightSpec disc_light(Vec3d position, double radius) {
  LightSpec light = sphere_light(position, radius);
  light.kind = LightKind::kDisc;
  light.normal = -position;
  return light;
}

inline LightSpec rectangle_light(Vec3d corner, Vec3d u, Vec3d v) {
  LightSpec light;
  light.kind = LightKind::kRectangle;
  light.position = corner;
  light.edge_u = u;
  light.edge_v = v;
  return light;
}

inline LightSpec point_light(Vec3d position) {
  LightSpec light;
  light.kind = LightKind::kPoint;
  light.position = position;
  return light;
}

inline RenderOptions small_picture() {
  RenderOptions options;
  options.width = 83;
  options.height = 59;
  options.occlusion_samples = 4;
  options.shadow_samples = 8;
  return options;
}

/// Returns options for a view straight down on the middle of the plane, with cells as cubes.
inline RenderOptions from_above(double height_of_picture) {
  RenderOptions options;
  options.width = options.height = 24;
  options.view.eye = {0, 40, 0};
  options.view.target = {0, 0, 0};
  options.view.up = {0, 0, -1};
  options.view.vertical_fov_degrees = 2 * std::atan(height_of_picture / 2 / 40.7) * 180 / kPi;
  options.lod_pixels = 0;
  options.cube_pixels = 0;
  options.with_sun = false;
  options.sky = 0;
  return options;
}

/// Returns the world x of the middle of a column, on the plane at y.
inline double column_x(const RenderedImage& image, int column, double y) {
  const double half = std::tan(image.view.vertical_fov_degrees * kPi / 360) * (40 - y);
  return (2 * (column + 0.5) / image.width - 1) * half;
}

}  // namespace voxdag
