// Pictures of ESVOs.
#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>

#include "support/ball_octree.hpp"
#include "support/brute_svdag.hpp"
#include "support/picture_checks.hpp"
#include "support/voxel_sets.hpp"
#include "voxdag/core/srgb.hpp"
#include "voxdag/cpu/render_image.hpp"

namespace voxdag {
namespace {

using test::expect_same_picture;
using test::kPictureLevels;
using test::picture_grid;

RenderOptions small_picture() {
  RenderOptions options;
  options.width = 97;
  options.height = 61;
  options.view.eye = {0.5, 1.2, 3};
  options.view.target = {0, 0, 0};
  options.occlusion_samples = 8;
  options.shadow_samples = 4;
  return options;
}

/// Red where x is high, blue where it is low.
VoxelValue ball_value(Vec3d middle) {
  VoxelValue value;
  value.color[middle.x > 0.5 ? 0 : 2] = 255;
  value.normal = static_cast<Vec3f>(Ball{}.normal(middle));
  return value;
}

Esvo ball(bool with_contours) {
  return pack_with_values(*ball_octree(Ball{}, kPictureLevels, with_contours), kPictureLevels,
                          ball_value);
}

Esvo random_shapes(unsigned seed) {
  std::mt19937 rng(seed);
  return TestEsvoAssembler(3, seed).assemble(*random_octree(rng, 0, kPictureLevels),
                                             kPictureLevels);
}

TEST(RenderEsvo, BeamsChangeNoPixel) {
  for (const Esvo& esvo : {ball(true), ball(false), random_shapes(1), random_shapes(2)})
    for (const float lod : {0.0f, 1.0f, 4.0f}) {
      RenderOptions options = small_picture();
      options.lod_pixels = lod;
      options.samples_per_pixel = 2;
      const RenderedImage with = render_image(esvo.view(), picture_grid(), options);
      options.beams = false;
      expect_same_picture(render_image(esvo.view(), picture_grid(), options), with);
    }
}

TEST(RenderEsvo, PixelsDoNotDependOnThreadsOrTiles) {
  const Esvo esvo = ball(true);
  RenderOptions options = small_picture();
  const RenderedImage first = render_image(esvo.view(), picture_grid(), options);
  options.tile_size = 7;
  RenderedImage other;
  tbb::task_arena(3).execute([&] { other = render_image(esvo.view(), picture_grid(), options); });
  expect_same_picture(first, other);
  EXPECT_EQ(first.rays, other.rays);
}

TEST(RenderEsvo, CubesAreWhereThoseOfTheDagAre) {
  for (const NamedVoxels& set : voxel_sets(kPictureLevels, 4)) {
    if (set.voxels.empty()) continue;
    const Svdag dag = brute_svdag(kPictureLevels, set.voxels);
    const Esvo esvo =
        TestEsvoAssembler(4, 1).assemble(*test_octree(kPictureLevels, set.voxels), kPictureLevels);
    RenderOptions options = small_picture();
    options.occlusion_samples = 0;
    options.shadows = false;
    EXPECT_EQ(render_image(esvo.view(), picture_grid(), options).depth,
              render_image(dag.view(), picture_grid(), options).depth)
        << set.name;
  }
}

TEST(RenderEsvo, ContoursHugTheBallAndItsNormalsAndColoursAreSeen) {
  const Grid grid = picture_grid();
  RenderOptions options = small_picture();
  options.lod_pixels = 0;
  const RenderedImage shapes = render_image(ball(true).view(), grid, options);
  const RenderedImage cubes = render_image(ball(false).view(), grid, options);
  const double radius = Ball{}.radius * 2;
  const Camera camera = make_camera(shapes.view, options.width, options.height);
  const auto mean_error = [&](const RenderedImage& image) {
    double sum = 0;
    int count = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const auto at = static_cast<std::size_t>(y * image.width + x);
        if (!(image.depth[at] < HUGE_VALF)) continue;
        const Vec3d p =
            camera.eye + camera.direction(x + 0.5, y + 0.5) * static_cast<double>(image.depth[at]);
        sum += std::fabs(std::sqrt(dot(p, p)) - radius);
        ++count;
      }
    return sum / count / grid.voxel_size;
  };
  EXPECT_LT(mean_error(shapes), 0.1);
  EXPECT_GT(mean_error(cubes), 0.4);

  int seen = 0, red = 0;
  for (int y = 0; y < shapes.height; ++y)
    for (int x = 0; x < shapes.width; ++x) {
      const auto at = static_cast<std::size_t>(y * shapes.width + x);
      if (!(shapes.depth[at] < HUGE_VALF)) continue;
      const Vec3d p =
          camera.eye + camera.direction(x + 0.5, y + 0.5) * static_cast<double>(shapes.depth[at]);
      // A block of 16 normals spans two cells of twice the voxel's size.
      EXPECT_GT(dot(shapes.normal[at], static_cast<Vec3f>(Ball{{}, 1}.normal(p))), 0.97f);
      if (std::fabs(p.x) < 0.15) continue;
      const Vec3f light = shapes.radiance[at];
      EXPECT_EQ(light.y, 0);
      EXPECT_EQ(light.x > light.z, p.x > 0);
      red += p.x > 0 ? 1 : 0;
      ++seen;
    }
  EXPECT_GT(seen, 300);
  EXPECT_GT(red, 100);
}

TEST(RenderEsvo, TheLitSideOfTheBallHasNoShadowsOfItsOwn) {
  RenderOptions options = small_picture();
  options.width = 160;
  options.height = 120;
  options.sun = Vec3d{0.5, 1.2, 3};  // from the camera
  options.sun_degrees = 0;
  const RenderedImage image = render_image(ball(true).view(), picture_grid(), options);
  int seen = 0, dark = 0;
  for (std::size_t i = 0; i < image.depth.size(); ++i) {
    if (!(image.depth[i] < HUGE_VALF)) continue;
    const Vec3d towards = normalized(Vec3d{0.5, 1.2, 3});
    if (dot(image.normal[i], static_cast<Vec3f>(towards)) < 0.3f) continue;
    ++seen;
    dark += image.shadow[i] < 1 ? 1 : 0;
  }
  EXPECT_GT(seen, 1500);
  EXPECT_LT(dark, seen / 200);
}

TEST(RenderEsvo, AFloorSeenAlongItFacesUpWhicheverWayItsNormalsPoint) {
  std::vector<Vec3i> voxels;
  const int side = 1 << kPictureLevels, middle = side / 2;
  for (int z = 0; z < side; ++z)
    for (int x = 0; x < side; ++x) voxels.push_back({x, middle - 1, z});
  for (const float up : {1.0f, -1.0f}) {
    const Esvo floor =
        pack_with_values(*test_octree(kPictureLevels, voxels), kPictureLevels, [up](Vec3d) {
          VoxelValue value;
          value.normal = {0, up, 0};
          return value;
        });
    RenderOptions options = small_picture();
    options.width = 200;
    options.height = 120;
    options.view.eye = {0, 0.2, 3};  // 4 degrees above
    options.lod_pixels = 0;
    const RenderedImage image = render_image(floor.view(), picture_grid(), options);
    int seen = 0;
    for (std::size_t i = 0; i < image.depth.size(); ++i) {
      if (!(image.depth[i] < HUGE_VALF) || image.depth[i] < 2.2f) continue;  // not its edge
      EXPECT_GT(image.normal[i].y, 0.9f);
      ++seen;
    }
    EXPECT_GT(seen, 100);
  }
}

TEST(RenderEsvo, WithoutViewOrAttributesItStillMakesAPicture) {
  RenderOptions options = small_picture();
  options.view = {};
  const RenderedImage image = render_image(random_shapes(3).view(), picture_grid(), options);
  const auto hits = std::count_if(image.depth.begin(), image.depth.end(),
                                  [](float depth) { return depth < HUGE_VALF; });
  EXPECT_GT(hits, 100);
  const RenderedImage empty =
      render_image(EsvoView{nullptr, 0, 0, kPictureLevels}, picture_grid(), options);
  EXPECT_EQ(empty.depth, std::vector<float>(empty.depth.size(), HUGE_VALF));
}

}  // namespace
}  // namespace voxdag
