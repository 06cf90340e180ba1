#pragma once
/// A small scene, and pictures of it that together need every effect.
#include <cmath>
#include <string>
#include <vector>

#include "support/brute_svdag.hpp"
#include "voxdag/render/render_options.hpp"
#include "voxdag/render/view_source.hpp"

namespace voxdag {

inline Grid picture_grid() {
  Grid grid;
  grid.levels = 6;
  grid.origin = {-1, -1, -1};
  grid.voxel_size = 2.0 / 64;
  return grid;
}

/// Returns a floor with a block, a ball and a thin roof.
inline Svdag picture_scene() {
  std::vector<Vec3i> voxels;
  for (std::int32_t z = 0; z < 64; ++z)
    for (std::int32_t x = 0; x < 64; ++x)
      for (std::int32_t y = 0; y < 64; ++y) {
        const Vec3i to_ball{x - 44, y - 18, z - 20};
        const bool is_floor = y < 3;
        const bool is_block = x >= 10 && x < 24 && z >= 24 && z < 40 && y < 30;
        const bool is_ball = dot(to_ball, to_ball) < 100;
        const bool is_roof = y == 45 && x + z < 60;
        if (is_floor || is_block || is_ball || is_roof) voxels.push_back({x, y, z});
      }
  return brute_svdag(6, voxels);
}

/// So many shadow rays per pixel and light that the CPU, too, casts beams to lights. Fewer give the
/// same pixels, but the CPU counts more rays than the device.
inline constexpr int kShadowRaysWithBeams = 64;

struct Picture {
  std::string name;
  RenderOptions options;
};

/// Returns the pictures. With `scale` 1 they have a few thousand pixels, in sizes that are not
/// multiples of a tile's.
inline std::vector<Picture> pictures(int scale) {
  RenderOptions options;
  options.width = 75 * scale;
  options.height = 45 * scale;
  options.view.eye = {2.5, 1.7, -2.1};
  options.occlusion_samples = 8;
  options.shadow_samples = kShadowRaysWithBeams;
  std::vector<Picture> list = {{"default", options}};
  const auto add = [&](const std::string& name) -> RenderOptions& {
    return list.emplace_back(Picture{name, options}).options;
  };
  RenderOptions& few = add("no beams, few shadow rays");
  few.beams = false;
  few.shadow_samples = 4;
  RenderOptions& hard = add("hard shadows");
  hard.sun_degrees = 0;
  hard.occlusion_samples = 0;
  add("no shadows").shadows = false;
  RenderOptions& shiny = add("highlights");
  shiny.specular = {0.5f, 50};
  shiny.samples_per_pixel = 2;
  shiny.shadow_samples = 2 * kShadowRaysWithBeams;
  RenderOptions& lamps = add("lamps");
  lamps.with_sun = false;
  LightSpec light;
  light.position = {0.5, 0.9, -0.5};
  light.radius = 0.1;
  for (const LightKind kind :
       {LightKind::kPoint, LightKind::kDisc, LightKind::kSphere, LightKind::kRectangle}) {
    light.kind = kind;
    light.edge_u = {0.2, 0, 0};
    light.edge_v = {0, 0.1, 0.2};
    light.position.x -= 0.3;
    lamps.lights.push_back(light);
  }
  lamps.specular = {0.3f, 15};
  RenderOptions& detail = add("level of detail");
  detail.lod_pixels = 3;
  detail.occlusion_cone = 0.07;
  detail.samples_per_pixel = 3;
  detail.shadow_samples = 3 * kShadowRaysWithBeams;
  RenderOptions& section = add("section");
  section.section.box = {{-1, -1, -0.9}, {0.35, 1, 0.6}};
  section.section.plane = {{0, 0.3, 0}, {-0.2, 1, 0.1}};
  section.lod_pixels = 2;
  RenderOptions& colors = add("colours and depth alone");
  colors.with_normal = colors.with_occlusion = colors.with_shadow = false;
  RenderOptions& paths = add("paths under an environment");
  paths.bounces = 2;
  paths.environment = std::make_shared<Environment>(built_in_environment("sunset"));
  paths.samples_per_pixel = 2;
  paths.shadow_samples = 2 * kShadowRaysWithBeams;
  paths.with_albedo = paths.with_cells = true;
  RenderOptions& steps = add("steps");
  steps.with_steps = true;
  steps.view.eye = {0.1, -0.6, -0.4};
  return list;
}

/// A source that sees the world plane y = -0.9, above the scene's floor.
class PlaneSource : public ViewSource {
 public:
  void sample(const Camera& camera, const ViewTile& tile,
              std::span<ViewSample> samples) const override {
    for (int i = 0; i < tile.width * tile.height; ++i) {
      const Vec3d direction =
          camera.direction(tile.x + i % tile.width + tile.dx, tile.y + i / tile.width + tile.dy);
      const double t = (-0.9 - camera.eye.y) / direction.y;
      if (!(t > 0)) continue;
      ViewSample& sample = samples[static_cast<std::size_t>(i)];
      sample.point = camera.eye + direction * t;
      sample.normal = sample.face = {0, 1, 0};
      sample.albedo = {0.5f, 0.6f, 0.7f};
      sample.depth = static_cast<float>(t);
    }
  }
};

}  // namespace voxdag
