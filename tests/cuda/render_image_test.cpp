#include "voxdag/cuda/render_image.hpp"

#include <gtest/gtest.h>

#include <atomic>

#include "cuda/cubes.hpp"
#include "cuda/cuda_device.hpp"
#include "cuda/like_the_cpu.hpp"
#include "cuda/pictures.hpp"
#include "support/ball_octree.hpp"
#include "support/mirror_attributes.hpp"
#include "support/number_colors.hpp"
#include "support/test_esvo.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/cpu/render_image.hpp"
#include "voxdag/cuda/device_attributes.hpp"

namespace voxdag {
namespace {

using CudaRender = OnCudaDevice;

void expect_like(const RenderedImage& image, const RenderedImage& expected) {
  expect_pixels_like(image, expected);
  EXPECT_EQ(image.steps, expected.steps);
  EXPECT_EQ(image.rays, expected.rays);
}

TEST_F(CudaRender, IsWithinOneGreyLevelOfTheCpuForEveryEffect) {
  const Svdag dag = picture_scene();
  const DeviceScene paper(device_, dag.view()), top(device_, dag.view(), DeviceLayout::kTop);
  for (const Picture& picture : pictures(4)) {
    SCOPED_TRACE(picture.name);
    const RenderedImage expected = render_image(dag.view(), picture_grid(), picture.options);
    expect_like(render_image(paper, picture_grid(), picture.options), expected);
    expect_like(render_image(top, picture_grid(), picture.options), expected);
  }
}

TEST_F(CudaRender, IsWithinOneGreyLevelOfTheCpuForAnEsvo) {
  std::mt19937 rng(4);
  const Esvo esvo = TestEsvoAssembler(3, 4).assemble(*random_octree(rng, 0, 6), 6);
  const DeviceScene scene(device_, esvo.view());
  for (const Picture& picture : pictures(4)) {
    SCOPED_TRACE(picture.name);
    expect_like(render_image(scene, picture_grid(), picture.options),
                render_image(esvo.view(), picture_grid(), picture.options));
  }
}

TEST_F(CudaRender, LooksUpColoursAndNormalsAsTheCpuDoes) {
  const Svdag dag = picture_scene();
  const Esvo look = pack_with_values(*ball_octree(Ball{}, 5, false), 5, [](Vec3d middle) {
    VoxelValue value;
    value.color[0] = static_cast<std::uint8_t>(255 * middle.x);
    value.normal = static_cast<Vec3f>(Ball{}.normal(middle));
    return value;
  });
  const DeviceScene scene(device_, dag.view()), device_look(device_, look.view());
  RenderOptions options = pictures(4)[0].options;
  options.look = look.view();
  const RenderedImage expected = render_image(dag.view(), picture_grid(), options);
  options.look = device_look.view().esvo;
  const RenderedImage image = render_image(scene, picture_grid(), options);
  expect_like(image, expected);
  EXPECT_EQ(image.normal, expected.normal);
}

TEST_F(CudaRender, LooksUpTheAttributesOfADagAsTheCpuDoes) {
  const Svdag dag = picture_scene();
  for (const int finest : {dag.levels, dag.levels - 2}) {
    const NumberColors attributes(dag.view(), finest);
    const ColoredDagView colored = attributes.view();
    const DeviceScene scene(device_, dag.view());
    const DeviceAttributes device_attributes(scene, colored.attributes);
    for (const Picture& picture : pictures(4)) {
      SCOPED_TRACE(picture.name);
      RenderOptions options = picture.options;
      options.look = colored;
      const RenderedImage expected = render_image(dag.view(), picture_grid(), options);
      EXPECT_NE(expected.radiance,
                render_image(dag.view(), picture_grid(), picture.options).radiance);
      options.look = device_attributes.view();
      const RenderedImage image = render_image(scene, picture_grid(), options);
      expect_like(image, expected);
    }
  }
}

TEST_F(CudaRender, MirrorsAsTheCpuDoes) {
  const Svdag dag = picture_scene();
  const DagAttributes attributes =
      mirror_attributes(dag.view(), {250, 200, 120}, true, [](std::uint64_t number) {
        return std::array{static_cast<std::uint8_t>(number % 5 * 60),
                          static_cast<std::uint8_t>(number % 256)};
      });
  const DeviceScene scene(device_, dag.view());
  const DeviceAttributes device_attributes(scene, attributes.view());
  for (const Picture& picture : pictures(4)) {
    SCOPED_TRACE(picture.name);
    RenderOptions options = picture.options;
    options.look = ColoredDagView{dag.view(), attributes.view()};
    const RenderedImage expected = render_image(dag.view(), picture_grid(), options);
    options.look = device_attributes.view();
    expect_like(render_image(scene, picture_grid(), options), expected);
    options.reflections = false;
    EXPECT_NE(render_image(scene, picture_grid(), options).radiance, expected.radiance);
  }
}

TEST_F(CudaRender, IsWithinOneGreyLevelOfTheCpuForTheCubesOfAnEsvo) {
  std::mt19937 rng(4);
  const Esvo esvo = TestEsvoAssembler(3, 4).assemble(*random_octree(rng, 0, 6), 6);
  const DeviceScene scene(device_, esvo.view(), DeviceLayout::kCubes);
  for (const Picture& picture : pictures(4)) {
    SCOPED_TRACE(picture.name);
    const RenderedImage expected = render_cubes(esvo.view(), picture_grid(), picture.options);
    expect_like(render_image(scene, picture_grid(), picture.options), expected);
    EXPECT_NE(expected.depth, render_image(esvo.view(), picture_grid(), picture.options).depth);
  }
}

TEST_F(CudaRender, FiltersAsTheCpuDoes) {
  const Svdag dag = picture_scene();
  RenderOptions options = pictures(4)[0].options;
  const DeviceScene scene(device_, dag.view());
  for (const FilterKind kind : {FilterKind::kNaive, FilterKind::kPlain, FilterKind::kGuided}) {
    options.filter = kind;
    const RenderedImage expected = render_image(dag.view(), picture_grid(), options);
    const RenderedImage image = render_image(scene, picture_grid(), options);
    expect_like(image, expected);
    EXPECT_EQ(image.cell_pixels, expected.cell_pixels);
  }
}

TEST_F(CudaRender, TakesPointsFromASource) {
  const Svdag dag = picture_scene();
  RenderOptions options = pictures(8)[0].options;  // several launches
  options.samples_per_pixel = 2;
  options.shadow_samples = 2 * kShadowRaysWithBeams;
  const PlaneSource source;
  expect_like(render_image(DeviceScene(device_, dag.view()), picture_grid(), options, {}, &source),
              render_image(dag.view(), picture_grid(), options, {}, &source));
}

/// A source that fails at the second sample of a pixel.
class FailingSource : public PlaneSource {
 public:
  void sample(const Camera& camera, const ViewTile& tile,
              std::span<ViewSample> samples) const override {
    if ((given_ += tile.pixels()) > camera.width * camera.height)
      throw Error("the mesh", "", "is gone");
    PlaneSource::sample(camera, tile, samples);
  }

 private:
  mutable std::atomic<int> given_ = 0;
};

TEST_F(CudaRender, WorksAgainAfterASourceFailedWhileTheDeviceRendered) {
  const Svdag dag = picture_scene();
  const DeviceScene scene(device_, dag.view());
  RenderOptions options = pictures(2)[0].options;
  options.samples_per_pixel = 2;
  options.shadow_samples = 2 * kShadowRaysWithBeams;
  const FailingSource failing;
  EXPECT_THROW(render_image(scene, picture_grid(), options, {}, &failing), Error);
  expect_like(render_image(scene, picture_grid(), options),
              render_image(dag.view(), picture_grid(), options));
}

TEST_F(CudaRender, AnEmptySceneIsSky) {
  const Svdag dag;
  RenderOptions options;
  options.width = options.height = 33;
  expect_like(render_image(DeviceScene(device_, dag.view()), Grid{}, options),
              render_image(dag.view(), Grid{}, options));
}

TEST_F(CudaRender, StopsWhenCancelled) {
  const Svdag dag = picture_scene();
  Progress progress;
  progress.cancel();
  EXPECT_THROW(render_image(DeviceScene(device_, dag.view()), picture_grid(),
                            pictures(1)[0].options, &progress),
               Cancelled);
}

}  // namespace
}  // namespace voxdag
