// Compares soft shadows and highlights with analytic values.
#include <gtest/gtest.h>

#include "cpu/effect_scenes.hpp"
#include "support/picture_checks.hpp"

namespace voxdag {
namespace {

using test::expect_same_picture;

TEST(SoftShadow, APlaneUnderASphereReceivesTheAnalyticIrradiance) {
  constexpr double kHeight = 1.5, kRadius = 0.2;
  const Svdag dag = dag_where(6, [](int, int y, int) { return y == 8; });
  const Grid grid = test_grid(6);
  RenderOptions options = from_above(1.8);
  const double floor = -1 + 9 * grid.voxel_size;
  options.lights = {sphere_light({0, floor + kHeight, 0}, kRadius)};
  options.lights[0].color = Vec3f{2, 2, 2};
  options.shadow_samples = 64;
  const RenderedImage image = render_image(dag.view(), grid, options);
  for (int row = 0; row < image.height; ++row)
    for (int column = 0; column < image.width; ++column) {
      const double x = column_x(image, column, floor), z = column_x(image, row, floor);
      const double distance2 = x * x + z * z + kHeight * kHeight;
      const double expected = 2 * kRadius * kRadius / distance2 * kHeight / std::sqrt(distance2) *
                              static_cast<double>(options.albedo.x);
      const Vec3f radiance = image.radiance[static_cast<std::size_t>(row * image.width + column)];
      EXPECT_NEAR(static_cast<double>(radiance.x) / expected, 1, 2e-3);
    }
}

TEST(SoftShadow, ThePenumbraOfAStraightEdgeIsACircularSegment) {
  constexpr int kLevels = 7, kTop = 100;
  const Svdag dag =
      dag_where(kLevels, [](int x, int y, int) { return y == 8 || (y == kTop && x < 64); });
  const Grid grid = test_grid(kLevels);
  RenderOptions options = from_above(1);
  // The cover hides the floor from above, so the camera is between cover and floor.
  options.view.eye = {0, -1 + 50 * grid.voxel_size, 0};
  options.view.target = {0, -1, 0};
  options.view.vertical_fov_degrees = 70;
  options.with_sun = true;
  options.sun = {0, 1, 0};
  options.sun_degrees = 20;
  options.occlusion_samples = 0;
  options.shadow_samples = 256;
  const RenderedImage image = render_image(dag.view(), grid, options);
  const double floor = 9 * grid.voxel_size - 1, start = floor + 1.25 * grid.voxel_size;
  const double gap = -1 + kTop * grid.voxel_size - start;
  const double radius = gap * std::tan(10 * kPi / 180);
  int half_lit = 0;
  for (int column = 0; column < image.width; ++column) {
    const double scale = std::tan(35 * kPi / 180) * (49.0 - 8) * grid.voxel_size;
    const double x = (2 * (column + 0.5) / image.width - 1) * scale;
    // The sun's disc, projected on the cover's plane around x, is free where it reaches beyond 0;
    // the cover has a thickness of a voxel, which only the far side of the disc sees.
    const double c = std::clamp(x / radius, -1.0, 1.0);
    const double expected = 1 - (std::acos(c) - c * std::sqrt(1 - c * c)) / kPi;
    double mean = 0;
    for (int row = 0; row < image.height; ++row)
      mean +=
          static_cast<double>(image.shadow[static_cast<std::size_t>(row * image.width + column)]) /
          image.height;
    half_lit += expected > 0.1 && expected < 0.9 ? 1 : 0;
    EXPECT_NEAR(mean, expected, 0.02) << x;
  }
  EXPECT_GE(half_lit, 3);
}

/// Returns the irradiance from each point of a light, and the direction to it, in double.
struct Arriving {
  Vec3d direction;
  double irradiance;
};
std::vector<Arriving> arriving(const LightSpec& light, Vec3d point) {
  const auto from = [&](Vec3d place, double emitted) {
    const Vec3d to_light = place - point, direction = normalized(to_light);
    return Arriving{direction, emitted * direction.y / dot(to_light, to_light)};
  };
  if (light.kind == LightKind::kSun) {
    const Vec3d direction = normalized(light.position);
    return {{direction, direction.y}};
  }
  if (light.kind == LightKind::kPoint) return {from(light.position, 1)};
  constexpr int kSteps = 40;
  const Vec3d span = cross(light.edge_u, light.edge_v), facing = normalized(span);
  std::vector<Arriving> all;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j) {
      const Vec3d place = light.position + light.edge_u * ((i + 0.5) / kSteps) +
                          light.edge_v * ((j + 0.5) / kSteps);
      const double cosine = std::fabs(dot(facing, normalized(place - point)));
      all.push_back(from(place, cosine * std::sqrt(dot(span, span)) / (kSteps * kSteps)));
    }
  return all;
}

TEST(Highlights, OnAPlaneEqualTheLobeInDoublePrecision) {
  const Svdag dag = dag_where(6, [](int, int y, int) { return y == 8; });
  LightSpec sun;
  sun.kind = LightKind::kSun;
  sun.position = {-0.6, 0.9, -0.5};
  for (LightSpec light : {sun, point_light({-0.3, 0.5, -0.5}),
                          rectangle_light({-0.6, 0.5, -0.9}, {0.5, 0, 0}, {0, 0, 0.6})}) {
    RenderOptions options = from_above(1);
    options.view.eye = {0.5, 0.6, 0.7};
    options.view.target = {0, -0.72, 0};
    options.view.up = {0, 1, 0};
    options.view.vertical_fov_degrees = 30;
    options.shadow_samples = 1024;
    options.albedo = {};  // only highlights
    options.specular = {0.25f, 12};
    light.color = Vec3f{1, 2, 3};
    options.lights = {light};
    const RenderedImage image = render_image(dag.view(), test_grid(6), options);
    const Camera camera = make_camera(image.view, image.width, image.height);
    double brightest = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const auto at = static_cast<std::size_t>(y * image.width + x);
        ASSERT_EQ(image.normal[at].y, 1) << "the picture shows the floor only";
        const Vec3d ray = camera.direction(x + 0.5, y + 0.5);
        const Vec3d mirrored = normalized(Vec3d{ray.x, -ray.y, ray.z});
        double expected = 0;
        for (const Arriving& part :
             arriving(light, camera.eye + ray * static_cast<double>(image.depth[at])))
          expected += part.irradiance * 0.25 * 14 / (2 * kPi) *
                      std::pow(std::max(0.0, dot(mirrored, part.direction)), 12);
        const Vec3f radiance = image.radiance[at];
        // 1024 samples of the rectangle against the midpoints of 1600 cells.
        const double tolerance = light.kind == LightKind::kRectangle ? 1e-2 : 1e-4;
        EXPECT_NEAR(static_cast<double>(radiance.x), expected, tolerance * expected + 1e-7);
        EXPECT_NEAR(static_cast<double>(radiance.z), 3 * expected, 3 * tolerance * expected + 1e-7);
        brightest = std::max(brightest, expected);
      }
    EXPECT_GT(brightest, 0.05);
  }
}

TEST(Highlights, AddToThePictureWhereLightArrives) {
  const Svdag dag = mixed_scene(6, 2);
  RenderOptions options = small_picture();
  options.sun_degrees = 0;
  options.lights = {point_light({0.2, 0.7, 0.9})};
  const RenderedImage dull = render_image(dag.view(), test_grid(6), options);
  options.specular = {0.3f, 20};
  const RenderedImage shiny = render_image(dag.view(), test_grid(6), options);
  EXPECT_EQ(shiny.rays, dull.rays);
  EXPECT_EQ(shiny.shadow, dull.shadow);
  int brighter = 0, dark = 0;
  for (std::size_t i = 0; i < dull.radiance.size(); ++i) {
    const float more = shiny.radiance[i].y - dull.radiance[i].y;
    EXPECT_GE(more, 0);
    brighter += more > 0.01f ? 1 : 0;
    if (dull.shadow[i] > 0 && !std::isinf(dull.depth[i])) continue;
    EXPECT_EQ(more, 0) << "in the shadow, or the sky";
    ++dark;
  }
  EXPECT_GT(brighter, 20);
  EXPECT_GT(dark, 20);
  options.specular = {0, 5};
  expect_same_picture(render_image(dag.view(), test_grid(6), options), dull);
}

TEST(RenderEffects, RefusesOptionsOutOfRange) {
  const Svdag dag = mixed_scene(4, 0);
  const auto refuses = [&](auto change) {
    RenderOptions options = small_picture();
    change(options);
    EXPECT_THROW(render_image(dag.view(), test_grid(4), options), Error);
  };
  refuses([](RenderOptions& o) { o.shadow_samples = 0; });
  refuses([](RenderOptions& o) { o.occlusion_samples = -1; });
  refuses([](RenderOptions& o) { o.occlusion_distance = HUGE_VAL; });
  refuses([](RenderOptions& o) { o.occlusion_cone = 7; });
  refuses([](RenderOptions& o) { o.sun_degrees = 90; });
  refuses([](RenderOptions& o) { o.sky = -1; });
  refuses([](RenderOptions& o) { o.tile_size = 33; });
  refuses([](RenderOptions& o) { o.specular.strength = 1.5f; });
  refuses([](RenderOptions& o) { o.specular.strength = NAN; });
  refuses([](RenderOptions& o) { o.specular.exponent = 0; });
  refuses([](RenderOptions& o) { o.specular.exponent = 10'001; });
  refuses([](RenderOptions& o) { o.lights = {LightSpec{}}; });
  refuses([](RenderOptions& o) { o.lights.assign(16, sphere_light({0, 0, 0}, 1)); });
}

}  // namespace
}  // namespace voxdag
