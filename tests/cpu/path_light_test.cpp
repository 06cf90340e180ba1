// Compares the light of traced paths with closed forms, and with the radiosity of a room.
#include <gtest/gtest.h>

#include <array>

#include "cpu/effect_scenes.hpp"
#include "support/picture_checks.hpp"

namespace voxdag {
namespace {

using test::expect_same_picture;

std::shared_ptr<const Environment> even_light(Vec3f radiance) {
  return std::make_shared<Environment>(16, [radiance](Vec3f) { return radiance; });
}

RenderOptions path_picture(int bounces, int paths) {
  RenderOptions options = small_picture();
  options.with_sun = false;
  options.bounces = bounces;
  options.occlusion_samples = paths;
  options.cube_pixels = 0;
  options.lod_pixels = 0;
  return options;
}

TEST(PathLight, WhiteSurfacesInAWhiteFurnaceCannotBeSeen) {
  // Every path leaves the scene in the end, and brings the same light.
  const Svdag dag = mixed_scene(5, 3);
  RenderOptions options = path_picture(64, 4);
  options.environment = even_light({2, 1, 0.5f});
  options.albedo = {1, 1, 1};
  const RenderedImage image = render_image(dag.view(), test_grid(5), options);
  double sum = 0;
  int hits = 0;
  for (std::size_t i = 0; i < image.radiance.size(); ++i) {
    if (!std::isfinite(image.depth[i])) continue;
    EXPECT_LE(image.radiance[i].y, 1.0001f);
    EXPECT_NEAR(image.radiance[i].x, 2 * image.radiance[i].y, 1e-4);
    sum += static_cast<double>(image.radiance[i].y);
    ++hits;
  }
  ASSERT_GT(hits, 500);
  EXPECT_GT(sum / hits, 0.997);  // some paths end in a crevice
}

TEST(PathLight, WithoutBouncesAPlaneReceivesTheSkysHarmonics) {
  const Svdag dag = dag_where(6, [](int, int y, int) { return y == 8; });
  RenderOptions options = path_picture(0, 1024);
  options.environment = std::make_shared<Environment>(64, [](Vec3f d) {
    return Vec3f{1 + 0.5f * d.x, 1 - d.z, 0.5f + d.z * d.z};
  });
  options.view = from_above(1.8).view;  // -z is up in the picture, so y is the map's -z
  const RenderedImage image = render_image(dag.view(), test_grid(6), options);
  const Vec3f seen = image.radiance[image.radiance.size() / 2];
  // The cosine-weighted means of x, -z and z² over the hemisphere are 0, 2/3 and 1/2.
  const Vec3f expected = Vec3f{1, 1 + 2.0f / 3, 1} * options.albedo;
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(seen[c] / expected[c], 1, 0.01);
}

/// The walls of a closed cubic room, [-1,1]³ inside, in patches.
class Radiosity {
 public:
  static constexpr int kSide = 14;

  /// Finds the irradiance, per pi, of all patches after `bounces` reflections of a point light of
  /// intensity 1 in the middle. albedo[2 * axis + side] is that of a wall.
  Radiosity(const std::array<double, 6>& albedo, int bounces) {
    for (int wall = 0; wall < 6; ++wall)
      for (int v = 0; v < kSide; ++v)
        for (int u = 0; u < kSide; ++u) {
          Patch patch;
          const int axis = wall / 2;
          patch.normal[axis] = wall % 2 == 0 ? 1 : -1;
          patch.middle[axis] = -patch.normal[axis];
          patch.middle[(axis + 1) % 3] = (2 * u + 1.0) / kSide - 1;
          patch.middle[(axis + 2) % 3] = (2 * v + 1.0) / kSide - 1;
          patch.albedo = albedo[static_cast<std::size_t>(wall)];
          const double distance2 = dot(patch.middle, patch.middle);
          patch.direct =
              -dot(patch.normal, patch.middle) / (distance2 * std::sqrt(distance2)) / kPi;
          patches_.push_back(patch);
        }
    light_.resize(patches_.size());
    for (std::size_t i = 0; i < light_.size(); ++i) light_[i] = patches_[i].direct;
    for (int bounce = 0; bounce < bounces; ++bounce) {
      std::vector<double> next(light_.size());
      for (std::size_t i = 0; i < light_.size(); ++i) {
        next[i] = patches_[i].direct;
        for (std::size_t j = 0; j < light_.size(); ++j)
          next[i] += form_factor(patches_[i], patches_[j]) * patches_[j].albedo * light_[j];
      }
      light_ = std::move(next);
    }
  }

  /// Returns the irradiance, per pi, at a place of the wall y = -1.
  double on_floor(double x, double z) const {
    Patch here;
    here.middle = {x, -1, z};
    here.normal = {0, 1, 0};
    const double distance2 = dot(here.middle, here.middle);
    double light = 1 / (distance2 * std::sqrt(distance2)) / kPi;
    for (std::size_t j = 0; j < light_.size(); ++j)
      light += form_factor(here, patches_[j]) * patches_[j].albedo * light_[j];
    return light;
  }

 private:
  struct Patch {
    Vec3d middle, normal;
    double albedo = 0, direct = 0;
  };
  /// Returns the part of the light of `from` that arrives at a point of `at`, with `from` divided
  /// into 3 × 3 parts.
  static double form_factor(const Patch& at, const Patch& from) {
    if (dot(at.normal, from.normal) == 1) return 0;
    const int axis = from.normal.x != 0 ? 0 : from.normal.y != 0 ? 1 : 2;
    double sum = 0;
    for (int part = 0; part < 9; ++part) {
      Vec3d to = from.middle - at.middle;
      to[(axis + 1) % 3] += (part % 3 - 1) * 2.0 / (3 * kSide);
      to[(axis + 2) % 3] += (part / 3 - 1) * 2.0 / (3 * kSide);
      const double distance2 = dot(to, to);
      const double cosines = dot(at.normal, to) * -dot(from.normal, to);
      if (cosines > 0) sum += cosines / (distance2 * distance2);
    }
    return sum * 4.0 / (9 * kSide * kSide) / kPi;
  }

  std::vector<Patch> patches_;
  std::vector<double> light_;
};

TEST(PathLight, ACornellBoxOfVoxelsHasTheLightOfItsRadiosity) {
  // The walls are one voxel thick, and the room inside is [-1,1]³.
  constexpr int kLevels = 7, kWall = 3, kSize = 1 << kLevels;
  const Svdag dag = dag_where(kLevels, [](int x, int y, int z) {
    const auto is_wall = [](int i) { return i == kWall || i == kSize - 1 - kWall; };
    const auto is_room = [](int i) { return i >= kWall && i < kSize - kWall; };
    return is_room(x) && is_room(y) && is_room(z) && (is_wall(x) || is_wall(y) || is_wall(z));
  });
  Grid grid = test_grid(kLevels);
  grid.voxel_size = 2.0 / (kSize - 2 * kWall - 2);
  grid.origin = Vec3d{1, 1, 1} * (-grid.side() / 2);
  constexpr double kAlbedo = 0.7, kPixel = 0.197;  // no pixel shows an edge of voxels
  RenderOptions options = path_picture(3, 1024);
  options.width = options.height = 7;
  options.albedo = Vec3f{1, 1, 1} * static_cast<float>(kAlbedo);
  options.lights = {point_light({0, 0, 0})};
  options.lights[0].color = Vec3f{1, 1, 1};
  options.view.eye = {0, 0.2, 0};
  options.view.target = {0, -1, 0};
  options.view.up = {0, 0, -1};
  options.view.vertical_fov_degrees = 2 * std::atan(3.5 * kPixel / 1.2) * 180 / kPi;
  for (const int bounces : {0, 1, 3}) {
    options.bounces = bounces;
    const RenderedImage image = render_image(dag.view(), grid, options);
    const Radiosity room({kAlbedo, kAlbedo, kAlbedo, kAlbedo, kAlbedo, kAlbedo}, bounces - 1);
    const Radiosity dark({0, 0, 0, 0, 0, 0}, 0);
    double sum = 0;
    for (int row = 0; row <= 3; ++row)
      for (int column = 0; column <= 3; ++column) {
        const double x = (column - 3) * kPixel, z = (row - 3) * kPixel;
        const double expected = (bounces == 0 ? dark : room).on_floor(x, z) * kAlbedo;
        // The mean of four places that mirror each other has less noise.
        double seen = 0;
        for (const int y : {row, 6 - row})
          for (const int at : {column, 6 - column})
            seen += static_cast<double>(image.radiance[static_cast<std::size_t>(y * 7 + at)].y) / 4;
        EXPECT_NEAR(seen / expected, 1, bounces == 0 ? 0.003 : 0.05)
            << bounces << ": " << x << ", " << z;
        sum += seen / expected;
      }
    EXPECT_NEAR(sum / 16, 1, bounces == 0 ? 0.002 : 0.01) << bounces;
  }
}

TEST(PathLight, PicturesDependNeitherOnTilesNorOnLayouts) {
  const Svdag dag = mixed_scene(5, 7);
  RenderOptions options = path_picture(3, 8);
  options.with_sun = true;
  options.cube_pixels = 24;
  options.lights = {sphere_light({0.5, 0.6, 0.4}, 0.1)};
  options.environment = std::make_shared<Environment>(built_in_environment("sunset"));
  const RenderedImage image = render_image(dag.view(), test_grid(5), options);
  options.tile_size = 7;
  expect_same_picture(render_image(dag.view(), test_grid(5), options), image);
  options.tile_size = 32;
  options.beams = false;
  expect_same_picture(render_image(dag.view(), test_grid(5), options), image);
}

}  // namespace
}  // namespace voxdag
