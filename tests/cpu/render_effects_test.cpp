// Tests that beams change nothing, and compares occlusion and soft shadows with analytic values.
#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "support/brute_svdag.hpp"
#include "support/picture_checks.hpp"
#include "voxdag/cpu/render_image.hpp"

namespace voxdag {
namespace {

constexpr double kPi = std::numbers::pi;

/// Returns a grid of 2^levels voxels a side over [-1,1]³.
Grid test_grid(int levels) {
  Grid grid;
  grid.levels = levels;
  grid.origin = {-1, -1, -1};
  grid.voxel_size = std::ldexp(2.0, -levels);
  return grid;
}

/// Returns a DAG of the voxels (x,y,z) of a grid of 2^levels for which keep(x,y,z) is true.
template <class Keep>
Svdag voxels_where(int levels, const Keep& keep) {
  std::vector<Vec3i> voxels;
  const std::int32_t n = 1 << levels;
  for (std::int32_t z = 0; z < n; ++z)
    for (std::int32_t y = 0; y < n; ++y)
      for (std::int32_t x = 0; x < n; ++x)
        if (keep(x, y, z)) voxels.push_back({x, y, z});
  return brute_svdag(levels, voxels);
}

/// Returns blocks, a shell and dust on a floor.
Svdag mixed_scene(int levels, unsigned seed) {
  std::mt19937 rng(seed);
  const double n = 1 << levels;
  return voxels_where(levels, [&](int x, int y, int z) {
    const double dx = x / n - 0.5, dy = y / n - 0.5, dz = z / n - 0.4;
    const double r = std::sqrt(dx * dx + dy * dy + dz * dz);
    const bool is_pillar = (x * 4 / (1 << levels)) % 2 == 1 && std::fabs(dz - 0.35) < 0.05;
    return y < 2 || std::fabs(r - 0.22) < 0.9 / n || (is_pillar && y < 0.7 * n) || rng() % 900 == 0;
  });
}

using test::expect_same_picture;

LightSpec sphere_light(Vec3d position, double radius) {
  LightSpec light;
  light.position = position;
  light.radius = radius;
  return light;
}

LightSpec disc_light(Vec3d position, double radius) {
  LightSpec light = sphere_light(position, radius);
  light.kind = LightKind::kDisc;
  light.normal = -position;
  return light;
}

LightSpec rectangle_light(Vec3d corner, Vec3d u, Vec3d v) {
  LightSpec light;
  light.kind = LightKind::kRectangle;
  light.position = corner;
  light.edge_u = u;
  light.edge_v = v;
  return light;
}

LightSpec point_light(Vec3d position) {
  LightSpec light;
  light.kind = LightKind::kPoint;
  light.position = position;
  return light;
}

RenderOptions small_picture() {
  RenderOptions options;
  options.width = 83;
  options.height = 59;
  options.occlusion_samples = 4;
  options.shadow_samples = 8;
  return options;
}

/// Shadow rays per pixel, enough for beams to lights (TileRenderer::kLeastRaysPerLightBeam).
constexpr int kSamplesWithBeams = 64;

TEST(RenderBeams, ChangeNoPixel) {
  constexpr int kLevels = 6;
  std::mt19937 rng(11);
  const auto number = [&](double lo, double hi) {
    return std::uniform_real_distribution<double>(lo, hi)(rng);
  };
  int shorter = 0;
  for (int i = 0; i < 40; ++i) {
    const Svdag dag = mixed_scene(kLevels, static_cast<unsigned>(i % 4));
    RenderOptions options = small_picture();
    const double reach = i % 2 == 0 ? 0.95 : 3;  // inside and outside
    options.view.eye = {number(-reach, reach), number(-0.8, reach), number(-reach, reach)};
    options.view.target = {number(-1, 1), number(-1, 0.5), number(-1, 1)};
    options.view.up = {0, 1, 0};
    options.view.vertical_fov_degrees = number(0, 1) < 0.2 ? 120 : number(5, 80);
    const float lods[] = {0, 1, 3, 12};
    options.lod_pixels = lods[i % 4];
    options.sun_degrees = i % 3 == 0 ? 0 : number(0.5, 20);
    options.shadow_samples = kSamplesWithBeams;
    options.with_steps = true;
    if (i % 5 == 0) options.section.box = {{-0.7, -0.9, -0.8}, {0.6, 0.7, 0.5}};
    if (i % 5 < 2) options.section.plane = {{0, 0.1, 0}, {number(-1, 1), 1, number(-1, 1)}};
    const RenderedImage with = render_image(dag.view(), test_grid(kLevels), options);
    options.beams = false;
    const RenderedImage without = render_image(dag.view(), test_grid(kLevels), options);
    expect_same_picture(with, without);
    double steps = 0;
    for (std::size_t at = 0; at < with.steps.size(); ++at)
      steps += static_cast<double>(without.steps[at] - with.steps[at]);
    shorter += steps > 0 ? 1 : 0;
  }
  EXPECT_GT(shorter, 5);  // at 64³ there is little to skip
}

TEST(RenderBeams, ChangeNoSoftShadowOfAnyLight) {
  constexpr int kLevels = 6;
  const Svdag dag = mixed_scene(kLevels, 2);
  const LightSpec lights[] = {sphere_light({0.3, 0.8, 0.2}, 0.1),
                              sphere_light({4, 9, -3}, 2),
                              sphere_light({-0.2, -0.5, 0.8}, 0.4),
                              disc_light({-0.7, 0.6, 0.4}, 0.3),
                              disc_light({0.1, 3, 0.1}, 0.01),
                              rectangle_light({-0.5, 0.9, -0.5}, {1, 0, 0}, {0, 0, 1}),
                              rectangle_light({2, 1, 0}, {0, 0, 1}, {0, 1, 0}),
                              point_light({0.2, 0.7, 0.9})};
  int fewer = 0;
  for (const LightSpec& light : lights) {
    RenderOptions options = small_picture();
    options.occlusion_samples = 0;
    options.with_sun = false;
    options.shadow_samples = kSamplesWithBeams;
    options.lights = {light};
    const RenderedImage with = render_image(dag.view(), test_grid(kLevels), options);
    options.beams = false;
    const RenderedImage without = render_image(dag.view(), test_grid(kLevels), options);
    expect_same_picture(with, without);
    EXPECT_LE(with.rays, without.rays);
    fewer += with.rays < without.rays ? 1 : 0;
    double shadow = 0;
    for (const float part : with.shadow) shadow += static_cast<double>(part);
    EXPECT_GT(shadow, 0);
    EXPECT_LT(shadow, static_cast<double>(with.shadow.size()));
  }
  EXPECT_GE(fewer, 3);  // wide beams meet something almost everywhere
}

TEST(RenderBeams, VoxelsRightBehindALampAreNotInItsWay) {
  // A post, and a roof whose lower side is the lamp's plane.
  const Svdag dag = voxels_where(
      6, [](int x, int y, int z) { return y < 8 || y >= 40 || (x == 30 && z == 34 && y < 20); });
  RenderOptions options = small_picture();
  options.view.eye = {0.7, 0.1, 0.9};
  options.view.target = {0, -0.75, 0};
  options.occlusion_samples = 0;
  options.with_sun = false;
  options.shadow_samples = kSamplesWithBeams;
  options.lights = {rectangle_light({-0.3, 0.25, -0.2}, {0.5, 0, 0}, {0, 0, 0.6})};
  const RenderedImage with = render_image(dag.view(), test_grid(6), options);
  options.beams = false;
  const RenderedImage without = render_image(dag.view(), test_grid(6), options);
  expect_same_picture(with, without);
  EXPECT_GT(std::accumulate(with.shadow.begin(), with.shadow.end(), 0.0f), 100);
}

TEST(RenderEffects, PicturesDependNeitherOnTilesNorThreads) {
  constexpr int kLevels = 6;
  const Svdag dag = mixed_scene(kLevels, 1);
  RenderOptions options = small_picture();
  options.samples_per_pixel = 3;
  options.specular = {0.5f, 9};
  options.lights = {sphere_light({0.3, 0.8, 0.2}, 0.1), point_light({0.2, 0.7, 0.9})};
  const RenderedImage expected = render_image(dag.view(), test_grid(kLevels), options);
  for (const int tile_size : {1, 7, 32})
    for (const int threads : {1, 3}) {
      options.tile_size = tile_size;
      RenderedImage image;
      tbb::task_arena(threads).execute(
          [&] { image = render_image(dag.view(), test_grid(kLevels), options); });
      expect_same_picture(image, expected);
      EXPECT_EQ(image.rays, expected.rays);
    }
}

/// Returns options for a view straight down on the middle of the plane, with cells as cubes.
RenderOptions from_above(double height_of_picture) {
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
double column_x(const RenderedImage& image, int column, double y) {
  const double half = std::tan(image.view.vertical_fov_degrees * kPi / 360) * (40 - y);
  return (2 * (column + 0.5) / image.width - 1) * half;
}

TEST(AmbientOcclusion, AnOpenPlaneHasNone) {
  const Svdag dag = voxels_where(6, [](int, int y, int) { return y == 8; });
  RenderOptions options = from_above(1);
  options.occlusion_distance = 1;
  const RenderedImage image = render_image(dag.view(), test_grid(6), options);
  for (const float open : image.occlusion) EXPECT_EQ(open, 1);
}

TEST(AmbientOcclusion, BesideAWallItEqualsQuadrature) {
  constexpr int kLevels = 7, kWall = 40;
  constexpr double kReach = 0.5;
  const Svdag dag =
      voxels_where(kLevels, [](int x, int y, int) { return y == 8 || (x == kWall && y > 8); });
  const Grid grid = test_grid(kLevels);
  const double wall = -1 + (kWall + 1) * grid.voxel_size, floor = -1 + 9 * grid.voxel_size;
  RenderOptions options = from_above(1.6);
  options.occlusion_samples = 256;
  options.occlusion_distance = kReach;
  const RenderedImage image = render_image(dag.view(), grid, options);

  // The mean over the hemisphere, cosine-weighted, of 1 - (1 - d/reach)² for the distance d to the
  // wall.
  const auto open_at = [&](double distance) {
    constexpr int kSteps = 400;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i)
      for (int j = 0; j < kSteps; ++j) {
        const double r = std::sqrt((i + 0.5) / kSteps), angle = 2 * kPi * (j + 0.5) / kSteps;
        const double towards = -r * std::cos(angle);
        const double d = towards > 0 ? distance / towards / kReach : 1;
        sum += d < 1 ? (1 - d) * (1 - d) : 0;
      }
    return 1 - sum / (kSteps * kSteps);
  };
  int near = 0;
  for (int column = 0; column < image.width; ++column) {
    const double x = column_x(image, column, floor);
    if (x < wall) continue;
    const double expected = open_at(x - wall);
    near += x - wall < kReach / 4 ? 1 : 0;
    double mean = 0;
    for (int row = 4; row < image.height - 4; ++row) {
      const float open = image.occlusion[static_cast<std::size_t>(row * image.width + column)];
      mean += static_cast<double>(open) / (image.height - 8);
      EXPECT_NEAR(static_cast<double>(open), expected, 0.06);  // 256 rays, well spread
    }
    EXPECT_NEAR(mean, expected, 0.012) << x - wall;
  }
  EXPECT_GE(near, 1);
}

TEST(AmbientOcclusion, TheEdgeOfAWallHidesHalfOfTheSky) {
  constexpr int kLevels = 8;
  const Svdag dag = voxels_where(kLevels, [](int x, int y, int z) {
    return std::abs(z - 128) < 40 && ((y == 8 && std::abs(x - 128) < 40) || (x == 127 && y > 8));
  });
  const Grid grid = test_grid(kLevels);
  RenderOptions options = from_above(0.001);  // 24 pixels in an eighth of a voxel
  options.view.eye = {0.0009, 40, 0};
  options.view.target = {0.0009, 0, 0};
  options.occlusion_distance = 1000;  // no wall is too far away to count
  const RenderedImage image = render_image(dag.view(), grid, options);
  double mean = 0;
  for (const float open : image.occlusion)
    mean += static_cast<double>(open) / static_cast<double>(image.occlusion.size());
  EXPECT_NEAR(mean, 0.5, 0.02);
}

TEST(AmbientOcclusion, AConeOnlyDarkens) {
  const Svdag dag = mixed_scene(6, 3);
  RenderOptions options = small_picture();
  options.occlusion_samples = 16;
  const RenderedImage exact = render_image(dag.view(), test_grid(6), options);
  options.occlusion_cone = 0.07;
  const RenderedImage cone = render_image(dag.view(), test_grid(6), options);
  double darker = 0;
  for (std::size_t i = 0; i < exact.occlusion.size(); ++i) {
    EXPECT_LE(cone.occlusion[i], exact.occlusion[i]);
    darker += static_cast<double>(exact.occlusion[i] - cone.occlusion[i]);
  }
  EXPECT_GT(darker, 0);
  EXPECT_LT(darker / static_cast<double>(exact.occlusion.size()), 0.2);
}

TEST(SoftShadow, APlaneUnderASphereReceivesTheAnalyticIrradiance) {
  constexpr double kHeight = 1.5, kRadius = 0.2;
  const Svdag dag = voxels_where(6, [](int, int y, int) { return y == 8; });
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
      voxels_where(kLevels, [](int x, int y, int) { return y == 8 || (y == kTop && x < 64); });
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
  const Svdag dag = voxels_where(6, [](int, int y, int) { return y == 8; });
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
