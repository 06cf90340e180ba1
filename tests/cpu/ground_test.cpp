#include "voxdag/render/ground.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cpu/effect_scenes.hpp"
#include "voxdag/render/coarse_cells.hpp"

namespace voxdag {
namespace {

/// A cube from -0.5 to 0 along x and z, 0.5 high, in the lower corner of its grid's height.
Svdag cube() {
  return dag_where(5, [](int x, int y, int z) {
    return x >= 8 && x < 16 && y >= 4 && y < 12 && z >= 8 && z < 16;
  });
}
constexpr double kFloor = -0.75;  // world height of the cube's lower side

RenderOptions ground_from_above() {
  RenderOptions options;
  options.width = 96;
  options.height = 80;
  options.view.eye = {-0.25, 4, -0.25};
  options.view.target = {-0.25, 0, -0.25001};
  options.view.up = {0, 1, 0};
  options.view.eye->z += 3;
  options.view.vertical_fov_degrees = 50;
  options.sun = {1, 0.8, -0.3};
  options.sun_degrees = 0;
  options.occlusion_samples = 0;
  options.lod_pixels = 0;
  options.ground = true;
  return options;
}

/// Returns whether a line meets the cube, made larger by `more` on all sides.
bool meets_cube(Vec3d from, Vec3d direction, double more) {
  const Vec3d lo{-0.5 - more, kFloor - more, -0.5 - more}, hi{more, kFloor + 0.5 + more, more};
  double near = 0, far = HUGE_VAL;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (lo[axis] - from[axis]) / direction[axis];
    const double b = (hi[axis] - from[axis]) / direction[axis];
    near = std::max(near, std::min(a, b));
    far = std::min(far, std::max(a, b));
  }
  return near < far;
}

TEST(Ground, ShowsTheExactShadowOfACube) {
  const Svdag dag = cube();
  RenderOptions options = ground_from_above();
  const RenderedImage image = render_image(dag.view(), test_grid(5), options);
  const Camera camera = make_camera(image.view, options.width, options.height);
  const Vec3d sun = normalized(*options.sun);
  int dark = 0, bright = 0;
  for (int y = 0; y < options.height; ++y)
    for (int x = 0; x < options.width; ++x) {
      const auto at = static_cast<std::size_t>(y * options.width + x);
      const Vec3d direction = camera.direction(x + 0.5, y + 0.5);
      if (std::isfinite(image.depth[at])) {
        EXPECT_EQ(image.coverage[at], 1);
        continue;
      }
      if (!(direction.y < 0)) continue;
      const Vec3d point = camera.eye + direction * ((kFloor - camera.eye.y) / direction.y);
      const Vec3d aside = point - Vec3d{-0.25, kFloor, -0.25};
      if (dot(aside, aside) > 0.7 * 0.7 ||
          meets_cube(point, sun, 0.03) != meets_cube(point, sun, -0.03))
        continue;
      const bool is_dark = meets_cube(point, sun, 0);
      EXPECT_EQ(image.coverage[at] > 0.05f, is_dark) << x << ", " << y;
      ++(is_dark ? dark : bright);
    }
  EXPECT_GT(dark, 50);
  EXPECT_GT(bright, 100);
  options.ground = false;
  const RenderedImage without = render_image(dag.view(), test_grid(5), options);
  for (std::size_t at = 0; at < without.depth.size(); ++at)
    EXPECT_EQ(without.coverage[at], std::isfinite(without.depth[at]) ? 1 : 0);
}

TEST(Ground, IsNotInASection) {
  const Svdag dag = cube();
  RenderOptions options = ground_from_above();
  options.section.box = Box3d{{-1, -1, -1}, {1, 1, 1}};
  const RenderedImage image = render_image(dag.view(), test_grid(5), options);
  for (std::size_t at = 0; at < image.depth.size(); ++at)
    EXPECT_EQ(image.coverage[at], std::isfinite(image.depth[at]) ? 1 : 0);
}

TEST(Background, HasOneColourAndATransparentOneLeavesTheSurfacesAsTheyAre) {
  const Svdag dag = cube();
  RenderOptions options = ground_from_above();
  options.ground = false;
  options.samples_per_pixel = 4;
  options.background = Background::kTransparent;
  const RenderedImage clear = render_image(dag.view(), test_grid(5), options);
  EXPECT_TRUE(clear.has_alpha);
  options.background = Background::kWhite;
  const RenderedImage white = render_image(dag.view(), test_grid(5), options);
  EXPECT_FALSE(white.has_alpha);
  EXPECT_EQ(white.exposure, clear.exposure);
  int mixed = 0;
  for (std::size_t at = 0; at < white.rgb.size(); ++at)
    for (int c = 0; c < 3; ++c) {
      const float coverage = clear.coverage[at];
      EXPECT_FLOAT_EQ(white.rgb[at][c], 1 - coverage + coverage * clear.rgb[at][c]);
      mixed += coverage > 0 && coverage < 1 ? 1 : 0;
    }
  EXPECT_GT(mixed, 20);
}

TEST(Background, TheSkyHasItsOwnExposure) {
  const Svdag dag = cube();
  RenderOptions options = ground_from_above();
  options.ground = false;
  options.exposure = 0.2f;
  const RenderedImage dark = render_image(dag.view(), test_grid(5), options);
  options.exposure = 5;
  const RenderedImage bright = render_image(dag.view(), test_grid(5), options);
  for (std::size_t at = 0; at < dark.rgb.size(); ++at)
    if (!std::isfinite(dark.depth[at])) {
      EXPECT_EQ(dark.rgb[at], bright.rgb[at]);
    }
}

TEST(LowestVoxel, IsThatOfAllVoxels) {
  std::mt19937 rng(3);
  for (int i = 0; i < 50; ++i) {
    std::vector<Vec3i> voxels;
    Vec3i lowest{64, 64, 64};
    for (int n = 0; n <= i; ++n) {
      const Vec3i v{static_cast<std::int32_t>(rng() % 64), static_cast<std::int32_t>(rng() % 64),
                    static_cast<std::int32_t>(rng() % 64)};
      voxels.push_back(v);
      for (int axis = 0; axis < 3; ++axis) lowest[axis] = std::min(lowest[axis], v[axis]);
    }
    const Svdag dag = brute_svdag(6, voxels);
    for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(lowest_voxel(dag.view(), axis), lowest[axis]);
  }
}

}  // namespace
}  // namespace voxdag
