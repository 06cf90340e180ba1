// Tests that beams, tiles and threads change nothing.
#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "cpu/effect_scenes.hpp"
#include "support/picture_checks.hpp"
#include "support/with_threads.hpp"

namespace voxdag {
namespace {

using test::expect_same_picture;

/// Shadow rays per pixel, enough for beams to lights (TileRenderer::kMinRaysPerLightBeam).
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
  const Svdag dag = dag_where(
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
      with_threads(threads, [&] { image = render_image(dag.view(), test_grid(kLevels), options); });
      expect_same_picture(image, expected);
      EXPECT_EQ(image.rays, expected.rays);
    }
}

}  // namespace
}  // namespace voxdag
