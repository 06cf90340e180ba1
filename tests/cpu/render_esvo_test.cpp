// Tests pictures of ESVOs.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "support/ball_octree.hpp"
#include "support/brute_svdag.hpp"
#include "support/picture_checks.hpp"
#include "support/voxel_sets.hpp"
#include "support/with_threads.hpp"
#include "voxdag/builders/esvo/build/build_esvo.hpp"
#include "voxdag/builders/voxelize/grid_mapping.hpp"
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

/// Returns red where x is high, blue where x is low.
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
      options.shadow_samples = 128;  // enough for beams to the sun
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
  with_threads(3, [&] { other = render_image(esvo.view(), picture_grid(), options); });
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

TEST(RenderEsvo, ADagWithItsLookLooksLikeItsCubes) {
  const Esvo esvo = ball(false);
  std::vector<Vec3i> voxels;
  const std::int32_t side = 1 << kPictureLevels;
  VoxelSet(esvo.view()).for_each_voxel({{0, 0, 0}, {side, side, side}}, [&](Vec3i voxel) {
    voxels.push_back(voxel);
  });
  const Svdag dag = brute_svdag(kPictureLevels, voxels);
  for (const float lod : {0.0f, 1.0f, 4.0f}) {
    RenderOptions options = small_picture();
    options.lod_pixels = lod;
    options.occlusion_samples = 0;
    options.with_sun = false;
    const RenderedImage cubes = render_image(esvo.view(), picture_grid(), options);
    const RenderedImage grey = render_image(dag.view(), picture_grid(), options);
    options.look = esvo.view();
    const RenderedImage looked_up = render_image(dag.view(), picture_grid(), options);
    EXPECT_EQ(looked_up.normal, cubes.normal);
    EXPECT_EQ(looked_up.depth, grey.depth);
    EXPECT_EQ(looked_up.radiance, cubes.radiance);
    EXPECT_NE(looked_up.radiance, grey.radiance);
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
      if (!(image.depth[i] < HUGE_VALF) || image.depth[i] < 2.2f) continue;  // not the edge
      EXPECT_GT(image.normal[i].y, 0.9f);
      ++seen;
    }
    EXPECT_GT(seen, 100);
  }
}

void add_box(Mesh& mesh, Vec3f lo, Vec3f hi) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int i = 0; i < 8; ++i)
    mesh.vertices.push_back(
        {(i & 1) != 0 ? hi.x : lo.x, (i & 2) != 0 ? hi.y : lo.y, (i & 4) != 0 ? hi.z : lo.z});
  for (const auto& [a, b, c, d] :
       {std::array{0u, 2u, 3u, 1u}, std::array{4u, 5u, 7u, 6u}, std::array{0u, 1u, 5u, 4u},
        std::array{2u, 6u, 7u, 3u}, std::array{0u, 4u, 6u, 2u}, std::array{1u, 3u, 7u, 5u}}) {
    mesh.triangles.push_back({first + a, first + b, first + c});
    mesh.triangles.push_back({first + a, first + c, first + d});
  }
}

TEST(RenderEsvo, ShadowsFallOnFlatFacesHoweverThickTheContoursAboveAre) {
  // A room with a table; in its shadow the fronts of its legs, which the planes of coarse contours
  // touch, too.
  Mesh mesh;
  add_box(mesh, {0, 0, 0}, {10, 0.2f, 8});
  add_box(mesh, {0, 0, 0}, {10, 4, 0.2f});
  add_box(mesh, {0, 0, 0}, {0.2f, 4, 8});
  add_box(mesh, {8, 0.2f, 1}, {9, 3, 2});
  add_box(mesh, {3, 0.2f, 3}, {3.4f, 2, 3.4f});
  add_box(mesh, {6, 0.2f, 3}, {6.4f, 2, 3.4f});
  add_box(mesh, {2.5f, 2, 2.5f}, {7, 2.2f, 4.5f});
  const Grid grid = fit_grid(mesh, 10);
  const Esvo esvo = build_esvo(mesh, grid);
  RenderOptions options = small_picture();
  options.width = 240;
  options.height = 150;
  options.view.eye = {8.5, 3.5, 9};
  options.view.target = {4.5, 1.3, 2.7};
  options.view.vertical_fov_degrees = 18;
  options.sun = Vec3d{0.5, 0.8, 0.6};
  options.sun_degrees = 0;
  options.lod_pixels = 0;
  const RenderedImage image = render_image(esvo.view(), grid, options);
  const Camera camera = make_camera(image.view, image.width, image.height);
  int seen = 0;
  for (std::size_t i = 0; i < image.depth.size(); ++i) {
    const auto column = static_cast<double>(i % 240), row = static_cast<double>(i / 240);
    const Vec3d at = camera.eye + camera.direction(column + 0.5, row + 0.5) *
                                      static_cast<double>(image.depth[i]);
    if (!(image.normal[i].z > 0.9f && at.z > 3.3 && at.z < 3.5 && at.y > 0.65 && at.y < 1.9 &&
          at.x < 6.1))
      continue;
    EXPECT_EQ(image.shadow[i], 0) << at.x << " " << at.y << " " << at.z;
    ++seen;
  }
  EXPECT_GT(seen, 500);
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
