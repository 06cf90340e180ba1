/// Runs the render kernel's body on the host, thread by thread.
#include "voxdag/cuda/render_pixel.hpp"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "cuda/pictures.hpp"
#include "support/picture_checks.hpp"
#include "support/test_esvo.hpp"
#include "voxdag/cpu/render_image.hpp"
#include "voxdag/cuda/beam_start.hpp"
#include "voxdag/render/render_plan.hpp"
#include "voxdag/render/source_view_samples.hpp"
#include "voxdag/trace/refill_caster.hpp"
#include "voxdag/trace/svdag_nodes.hpp"

namespace voxdag {
namespace {

std::vector<ViewSample> samples_of(const ViewSource& source, const RenderSetup& setup,
                                   const LaunchRange& range) {
  std::vector<ViewSample> samples((range.last_block - range.first_block) * kBlockPixels);
  for (std::uint32_t block = range.first_block; block < range.last_block; ++block) {
    ViewTile tile = block_tile(setup.camera, block);
    set_sample(tile, range.first_sample);
    find_source_samples(source, setup, tile,
                        std::span(samples).subspan((block - range.first_block) * kBlockPixels,
                                                   tile.width * tile.height));
  }
  return samples;
}

/// Renders a picture in launches of a few blocks, as the device does.
template <class Nodes, class Caster>
RenderedImage render_as_device(const VoxelSet& scene, const Nodes& nodes, const Caster& caster,
                               const RenderOptions& options, const ViewSource* source) {
  const Grid grid = picture_grid();
  RenderPlan plan(scene, grid, options);
  RenderSetup setup = plan.setup();
  std::vector<float> starts;
  if (options.beams && source == nullptr) {
    starts.resize(static_cast<std::size_t>(beams_across(options.width)) *
                  static_cast<std::size_t>(beams_across(options.height)));
    for (std::uint32_t i = 0; i < starts.size(); ++i)
      set_beam_start(nodes, setup, i, starts.data());
    setup.beam_starts = starts.data();
  }
  const int max_samples = source == nullptr ? options.samples_per_pixel : 1;
  LaunchPlan launches(block_count(options.width, options.height), options.samples_per_pixel, 1, 7,
                      20, max_samples);
  while (const auto range = launches.next()) {
    std::vector<ViewSample> samples;
    if (source != nullptr) samples = samples_of(*source, setup, *range);
    for (std::uint32_t block = range->first_block; block < range->last_block; ++block)
      for (std::uint32_t thread = 0; thread < kBlockPixels; ++thread)
        plan.image().rays += render_pixel<TileScratch<1, PathScratch<1>>>(
            nodes, caster, setup, *range, source == nullptr ? nullptr : samples.data(), block,
            thread);
  }
  return plan.finish();
}

void expect_equal(const RenderedImage& image, const RenderedImage& expected) {
  test::expect_same_picture(image, expected);
  EXPECT_EQ(image.rays, expected.rays);
}

TEST(RenderPixel, BeamsOfThreadsAreThoseOfTheCpu) {
  const Svdag dag = picture_scene();
  const RenderPlan plan(dag.view(), picture_grid(), pictures(1)[0].options);
  const Camera& camera = plan.setup().camera;
  const SvdagNodes nodes(dag.view());
  std::vector<float> expected(static_cast<std::size_t>(beams_across(camera.width)) *
                              static_cast<std::size_t>(beams_across(camera.height)));
  for (int y = 0; y < camera.height; y += kCoarseBeamPixels)
    for (int x = 0; x < camera.width; x += kCoarseBeamPixels)
      set_beam_starts(nodes, plan.setup(), x, y, expected.data());
  std::vector<float> starts(expected.size());
  for (std::uint32_t i = 0; i < starts.size(); ++i)
    set_beam_start(nodes, plan.setup(), i, starts.data());
  EXPECT_EQ(starts, expected);
}

TEST(RenderPixel, ThreadsCoverTheirBlockInWarpsOfEightByFour) {
  std::set<std::pair<int, int>> seen;
  for (std::uint32_t thread = 0; thread < kBlockPixels; ++thread) {
    const int x = thread_x(thread), y = thread_y(thread);
    EXPECT_TRUE(x < kBlockWidth && y < kBlockHeight);
    seen.insert({x, y});
    const std::uint32_t first = thread & ~31u;
    EXPECT_EQ(x / 8, thread_x(first) / 8);
    EXPECT_EQ(y / 4, thread_y(first) / 4);
  }
  EXPECT_EQ(seen.size(), kBlockPixels);
}

TEST(RenderPixel, EqualsTheTilesOfTheCpuForEveryEffect) {
  const Svdag dag = picture_scene();
  const TopGrid grid = make_top_grid(dag.view(), 2);
  const ScalarCaster paper(SvdagNodes(dag.view()));
  const RefillCaster<> top(TopNodes(dag.view(), grid.view()));
  for (Picture& picture : pictures(1)) {
    SCOPED_TRACE(picture.name);
    picture.options.with_steps = false;  // another kernel counts steps
    const RenderedImage expected = render_image(dag.view(), picture_grid(), picture.options);
    expect_equal(
        render_as_device(dag.view(), SvdagNodes(dag.view()), paper, picture.options, nullptr),
        expected);
    expect_equal(
        render_as_device(dag.view(), SvdagNodes(dag.view()), top, picture.options, nullptr),
        expected);
  }
}

TEST(RenderPixel, EqualsTheTilesOfTheCpuForPointsFromASource) {
  const Svdag dag = picture_scene();
  RenderOptions options = pictures(1)[0].options;
  options.samples_per_pixel = 2;
  options.shadow_samples = 2 * kShadowRaysWithBeams;
  const PlaneSource source;
  const ScalarCaster caster(SvdagNodes(dag.view()));
  expect_equal(render_as_device(dag.view(), SvdagNodes(dag.view()), caster, options, &source),
               render_image(dag.view(), picture_grid(), options, {}, &source));
}

TEST(RenderPixel, EqualsTheTilesOfTheCpuForAnEsvo) {
  std::mt19937 rng(4);
  const Esvo esvo = TestEsvoAssembler(3, 4).assemble(*random_octree(rng, 0, 6), 6);
  const ContourNodes nodes(esvo.view());
  for (Picture& picture : pictures(1)) {
    SCOPED_TRACE(picture.name);
    picture.options.with_steps = false;  // another kernel counts steps
    expect_equal(
        render_as_device(esvo.view(), nodes, ScalarCaster(nodes), picture.options, nullptr),
        render_image(esvo.view(), picture_grid(), picture.options));
  }
}

}  // namespace
}  // namespace voxdag
