#include "voxdag/cpu/render_image.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/brute_svdag.hpp"
#include "support/picture_checks.hpp"
#include "support/with_threads.hpp"
#include "voxdag/cpu/post_filter.hpp"

namespace voxdag {
namespace {

using test::kPictureLevels;
using test::picture_grid;

/// Returns a floor at y < 8 voxels and a block on it.
Svdag block_on_a_floor() {
  std::vector<Vec3i> voxels;
  for (std::int32_t z = 0; z < 64; ++z)
    for (std::int32_t x = 0; x < 64; ++x)
      for (std::int32_t y = 6; y < 40; ++y) {
        const bool is_block = std::min(x, z) >= 24 && std::max(x, z) < 40;
        if (y < 8 || is_block) voxels.push_back({x, y, z});
      }
  return brute_svdag(kPictureLevels, voxels);
}

RenderOptions small_options() {
  RenderOptions options;
  options.width = 97;
  options.height = 61;
  options.lod_pixels = 0;
  return options;
}

TEST(RenderImage, HasOnlyTheValuesThatTheOptionsAskFor) {
  const Svdag dag = block_on_a_floor();
  RenderOptions options = small_options();
  const RenderedImage all = render_image(dag.view(), picture_grid(), options);
  options.with_normal = options.with_occlusion = options.with_shadow = false;
  const RenderedImage few = render_image(dag.view(), picture_grid(), options);
  EXPECT_EQ(few.rgb, all.rgb);
  EXPECT_EQ(few.depth, all.depth);
  EXPECT_TRUE(few.normal.empty() && few.occlusion.empty() && few.shadow.empty());
  options.filter = FilterKind::kGuided;
  EXPECT_EQ(render_image(dag.view(), picture_grid(), options).normal, all.normal);
}

TEST(RenderImage, PixelsDoNotDependOnThreads) {
  const Svdag dag = block_on_a_floor();
  RenderOptions options = small_options();
  options.samples_per_pixel = 3;
  RenderedImage first;
  for (const int threads : {1, 2, 7}) {
    RenderedImage image;
    with_threads(threads, [&] { image = render_image(dag.view(), picture_grid(), options); });
    if (threads == 1) first = image;
    EXPECT_EQ(image.rgb, first.rgb);
    EXPECT_EQ(image.depth, first.depth);
    EXPECT_EQ(image.normal, first.normal);
    EXPECT_EQ(image.rays, first.rays);
  }
}

TEST(RenderImage, DepthOfAFacingPlaneIsItsDistance) {
  const Svdag dag = block_on_a_floor();
  RenderOptions options = small_options();
  options.view.eye = {0.1, 3, 0.2};  // above the block, whose top is at y = -1 + 40 / 32
  options.view.target = {0.1, 0, 0.2};
  options.view.up = {0, 0, -1};
  options.view.vertical_fov_degrees = 2;
  const RenderedImage image = render_image(dag.view(), picture_grid(), options);
  for (std::size_t i = 0; i < image.depth.size(); ++i) {
    EXPECT_NEAR(image.depth[i], 3 - 0.25, 1e-5);
    EXPECT_NEAR(image.normal[i].y, 1, 0.02);
  }
}

/// Returns the voxels of block_on_a_floor() with z >= 30 and y < 20.
Svdag part_of_a_block() {
  std::vector<Vec3i> voxels;
  for (std::int32_t z = 30; z < 64; ++z)
    for (std::int32_t x = 0; x < 64; ++x)
      for (std::int32_t y = 6; y < 20; ++y) {
        const bool is_block = std::min(x, z) >= 24 && std::max(x, z) < 40;
        if (y < 8 || is_block) voxels.push_back({x, y, z});
      }
  return brute_svdag(kPictureLevels, voxels);
}

TEST(RenderImage, ASectionShowsThatPartAndColoursTheCut) {
  const Svdag dag = block_on_a_floor(), part = part_of_a_block();
  RenderOptions options = small_options();
  options.view.eye = {0.3, 0.9, -2.5};
  options.view.target = {0, -0.7, 0};
  options.exposure = 1;
  options.with_sun = false;
  options.cube_pixels = 0;
  RenderOptions cut = options;
  cut.section.box = {{-1, -1, -1 + 30 * 2.0 / 64}, {1, -1 + 20 * 2.0 / 64, 1}};
  const RenderedImage image = render_image(dag.view(), picture_grid(), cut);
  const RenderedImage expected = render_image(part.view(), picture_grid(), options);
  // The cuts lie between voxels, so both show the same surfaces in the same light.
  EXPECT_EQ(image.depth, expected.depth);
  EXPECT_EQ(image.occlusion, expected.occlusion);
  int cuts = 0, others = 0;
  for (std::size_t i = 0; i < image.depth.size(); ++i) {
    if (!std::isfinite(image.depth[i])) continue;
    const Vec3f normal = image.normal[i];
    EXPECT_EQ(normal, expected.normal[i]);
    // Only the block has voxels on both sides of its top; the floor and the block are cut in front.
    const bool is_cut = image.radiance[i] != expected.radiance[i];
    if (is_cut) {
      EXPECT_TRUE(normal == (Vec3f{0, 0, -1}) || normal == (Vec3f{0, 1, 0}));
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(image.radiance[i][c] / expected.radiance[i][c],
                    kCutAlbedo[c] / options.albedo[c], 1e-4);
    }
    ++(is_cut ? cuts : others);
  }
  EXPECT_GT(cuts, 50);
  EXPECT_GT(others, 100);
}

TEST(RenderImage, APlaneCutsAlongItsNormal) {
  const Svdag dag = block_on_a_floor();
  RenderOptions options = small_options();
  options.view.eye = {0.1, 3, 0.2};
  options.view.target = {0.1, 0, 0.2};
  options.view.up = {0, 0, -1};
  options.view.vertical_fov_degrees = 1;
  options.section.plane = {{0, -0.5, 0}, {0, 7, 0}};
  const RenderedImage image = render_image(dag.view(), picture_grid(), options);
  for (std::size_t i = 0; i < image.depth.size(); ++i) {
    EXPECT_NEAR(image.depth[i], 3.5, 1e-5);
    EXPECT_EQ(image.normal[i], (Vec3f{0, 1, 0}));
  }
  // Nothing is left on the other side.
  options.section.plane = {{0, 0.3, 0}, {0, -1, 0}};
  const RenderedImage nothing = render_image(dag.view(), picture_grid(), options);
  for (const float depth : nothing.depth) EXPECT_FALSE(std::isfinite(depth));
}

TEST(RenderImage, TheFilterIsOfTheVoxelsSizes) {
  const Svdag dag = block_on_a_floor();
  RenderOptions options = small_options();
  options.view.eye = {0.1, 3, 0.2};
  options.view.target = {0.1, 0, 0.2};
  options.view.up = {0, 0, -1};
  options.view.vertical_fov_degrees = 2;
  const RenderedImage plain = render_image(dag.view(), picture_grid(), options);
  EXPECT_TRUE(plain.cell_pixels.empty());
  options.filter = FilterKind::kGuided;
  const RenderedImage filtered = render_image(dag.view(), picture_grid(), options);
  // The side of a voxel divided by the side of a pixel at its distance.
  const double size = 2.0 / 64 / (2 * std::tan(3.14159265 / 180) / 61 * 2.75);
  for (const std::uint8_t code : filtered.cell_pixels)
    EXPECT_NEAR(unpack_cell_pixels(code), size, 0.02 * size);
  RenderedImage expected = plain;
  expected.cell_pixels = filtered.cell_pixels;
  filter_picture(expected, FilterKind::kGuided);
  EXPECT_EQ(filtered.radiance, expected.radiance);
  EXPECT_NE(filtered.radiance, plain.radiance);
}

TEST(RenderImage, EachKindOfFilterIsThatOfTheUnfilteredPicture) {
  const Svdag dag = block_on_a_floor();
  RenderOptions options = small_options();
  options.view.eye = {0.5, 1, 2};
  options.view.target = {0, -0.5, 0};
  options.view.vertical_fov_degrees = 20;
  const RenderedImage unfiltered = render_image(dag.view(), picture_grid(), options);
  std::vector<std::vector<Vec3f>> pictures{unfiltered.radiance};
  for (const FilterKind kind : {FilterKind::kNaive, FilterKind::kPlain, FilterKind::kGuided}) {
    options.filter = kind;
    const RenderedImage image = render_image(dag.view(), picture_grid(), options);
    std::vector<Vec3f> surfaces = unfiltered.radiance;
    for (std::size_t i = 0; i < surfaces.size(); ++i)
      if (image.coverage[i] == 0) surfaces[i] = {};
    FilterInput input{surfaces.data(), image.cell_pixels.data(), image.width, image.height};
    input.coverage = image.coverage.data();
    if (kind == FilterKind::kGuided)
      input.guides = {image.depth.data(), image.normal.data(), image.occlusion.data(),
                      image.shadow.data(), make_camera(image.view, image.width, image.height)};
    input.shrinks = kind != FilterKind::kNaive;
    std::vector<Vec3f> expected = filter_picture(input);
    for (std::size_t i = 0; i < surfaces.size(); ++i)
      if (image.coverage[i] == 0) expected[i] = unfiltered.radiance[i];
    EXPECT_EQ(image.radiance, expected);
    for (const std::vector<Vec3f>& other : pictures) EXPECT_NE(image.radiance, other);
    pictures.push_back(image.radiance);
  }
}

TEST(RenderImage, TheFilterLeavesTheSkyAlone) {
  const Svdag dag = block_on_a_floor();
  RenderOptions options = small_options();
  options.filter = FilterKind::kGuided;
  options.view.eye = {0, 1, 6};
  const RenderedImage filtered = render_image(dag.view(), picture_grid(), options);
  options.filter = FilterKind::kNone;
  const RenderedImage plain = render_image(dag.view(), picture_grid(), options);
  int sky = 0;
  for (std::size_t i = 0; i < plain.depth.size(); ++i) {
    if (plain.depth[i] < HUGE_VALF) continue;
    EXPECT_EQ(filtered.radiance[i], plain.radiance[i]);
    EXPECT_EQ(filtered.cell_pixels[i], 0);
    ++sky;
  }
  EXPECT_GT(sky, 100);
}

TEST(RenderImage, TheBlockShadowsTheFloorAndNothingElseIsDark) {
  const Svdag dag = block_on_a_floor();
  RenderOptions options = small_options();
  options.view.eye = {0, 6, 3};
  options.view.target = {0, -0.8, 0};
  options.exposure = 0.5f;
  RenderedImage with = render_image(dag.view(), picture_grid(), options);
  options.shadows = false;
  RenderedImage without = render_image(dag.view(), picture_grid(), options);
  int floor = 0, darker = 0;
  for (std::size_t i = 0; i < with.rgb.size(); ++i) {
    const bool is_darker = with.rgb[i].x < without.rgb[i].x;
    EXPECT_LE(with.rgb[i].x, without.rgb[i].x);
    const Vec3f n = with.normal[i];
    if (n.y > 0.999f && with.depth[i] > 6) {
      ++floor;
      darker += is_darker ? 1 : 0;
    }
  }
  EXPECT_GT(darker, floor / 50);
  EXPECT_LT(darker, floor / 2);
}

TEST(RenderImage, ASlantedPlaneDoesNotShadowItself) {
  std::vector<Vec3i> voxels;
  for (std::int32_t z = 0; z < 64; ++z)
    for (std::int32_t x = 0; x < 64; ++x) voxels.push_back({x, (2 * x + z) / 5 + 5, z});
  const Svdag dag = brute_svdag(kPictureLevels, voxels);
  RenderOptions options = small_options();
  const RenderedImage with = render_image(dag.view(), picture_grid(), options);
  options.shadows = false;
  EXPECT_EQ(with.rgb, render_image(dag.view(), picture_grid(), options).rgb);
}

TEST(RenderImage, TheSunLightsTheSideThatFacesIt) {
  const Svdag dag = block_on_a_floor();
  RenderOptions options = small_options();
  options.view.eye = {0, 0, 6};
  options.view.target = {0, 0, 0};
  options.view.vertical_fov_degrees = 2;  // the front of the block, at z = 0.25
  options.exposure = 0.1f;
  options.sun = {0, 0, 7};
  const RenderedImage lit = render_image(dag.view(), picture_grid(), options);
  options.sun = {0, 1, -2};
  const RenderedImage unlit = render_image(dag.view(), picture_grid(), options);
  for (std::size_t i = 0; i < lit.rgb.size(); ++i) EXPECT_GT(lit.rgb[i].x, 2 * unlit.rgb[i].x);
  options.sun = {0, 0, 0};
  EXPECT_THROW(render_image(dag.view(), picture_grid(), options), Error);
}

TEST(RenderImage, AnEmptySceneIsSky) {
  const RenderedImage image = render_image(Svdag{}.view(), Grid{}, small_options());
  for (std::size_t i = 0; i < image.depth.size(); ++i) {
    EXPECT_TRUE(std::isinf(image.depth[i]));
    EXPECT_EQ(image.normal[i], Vec3f{});
    EXPECT_GT(image.rgb[i].z, 0);
  }
}

TEST(RenderImage, RefusesImpossibleSizesAndStopsWhenCancelled) {
  const Svdag dag = block_on_a_floor();
  for (const auto [width, height, samples] : {std::array{0, 10, 1}, std::array{10, -1, 1},
                                              std::array{10, 70000, 1}, std::array{9, 9, 0}}) {
    RenderOptions options;
    options.width = width;
    options.height = height;
    options.samples_per_pixel = samples;
    EXPECT_THROW(render_image(dag.view(), picture_grid(), options), Error);
  }
  Progress progress;
  progress.cancel();
  EXPECT_THROW(render_image(dag.view(), picture_grid(), small_options(), &progress), Cancelled);
}

}  // namespace
}  // namespace voxdag
