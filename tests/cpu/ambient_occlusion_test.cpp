// Compares ambient occlusion with analytic values and quadrature.
#include <gtest/gtest.h>

#include "cpu/effect_scenes.hpp"

namespace voxdag {
namespace {

TEST(AmbientOcclusion, AnOpenPlaneHasNone) {
  const Svdag dag = dag_where(6, [](int, int y, int) { return y == 8; });
  RenderOptions options = from_above(1);
  options.occlusion_distance = 1;
  const RenderedImage image = render_image(dag.view(), test_grid(6), options);
  for (const float open : image.occlusion) EXPECT_EQ(open, 1);
}

TEST(AmbientOcclusion, BesideAWallItEqualsQuadrature) {
  constexpr int kLevels = 7, kWall = 40;
  constexpr double kReach = 0.5;
  const Svdag dag =
      dag_where(kLevels, [](int x, int y, int) { return y == 8 || (x == kWall && y > 8); });
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
  const Svdag dag = dag_where(kLevels, [](int x, int y, int z) {
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

}  // namespace
}  // namespace voxdag
