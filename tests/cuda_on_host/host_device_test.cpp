#include "cuda_on_host/host_device.hpp"

#include <gtest/gtest.h>

#include "cuda/cubes.hpp"
#include "cuda/pictures.hpp"
#include "support/picture_checks.hpp"
#include "support/test_esvo.hpp"
#include "support/test_rays.hpp"
#include "support/wavy_file.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/cpu/render_image.hpp"
#include "voxdag/cpu/trace_batch.hpp"
#include "voxdag/cuda/device.hpp"
#include "voxdag/cuda/device_stream.hpp"
#include "voxdag/cuda/memory.hpp"
#include "voxdag/cuda/render_image.hpp"
#include "voxdag/cuda/timed_casts.hpp"
#include "voxdag/cuda/trace_batch.hpp"
#include "voxdag/render/render_plan.hpp"

namespace voxdag {
namespace {

class CudaOnHost : public testing::Test {
 protected:
  void SetUp() override { host_device() = {}; }
  void TearDown() override {
    EXPECT_TRUE(host_device().holds_nothing());
    host_device() = {};
  }
};

/// Returns the message of the Error that work() throws, or "".
template <class Work>
std::string failure(const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST_F(CudaOnHost, NoDeviceIsOneLineThatSaysWhy) {
  const auto why = [] { return failure([] { choose_cuda_device(); }); };
  EXPECT_EQ(why(), "");
  host_device().count = 0;
  EXPECT_EQ(why(), "no CUDA device: the NVIDIA driver finds no device");
  host_device().driver_version = 0;
  EXPECT_EQ(why(), "no CUDA device: no NVIDIA driver is installed");
  host_device().driver_version = 11080;
  EXPECT_EQ(why(),
            "no CUDA device: the NVIDIA driver supports CUDA 11.8, but voxdag needs 13.0 or later");
  host_device() = {};
  host_device().compute_capability = 61;
  EXPECT_EQ(why(),
            "no CUDA device: the host has compute capability 6.1, but voxdag needs 7.5 or later");
}

TEST_F(CudaOnHost, OutOfMemorySaysHowMuchIsNeeded) {
  const Svdag dag = picture_scene();
  host_device().memory_bytes = 1 << 20;
  const DeviceScene scene(choose_cuda_device(), dag.view());
  RenderOptions options = pictures(1)[0].options;
  options.width = options.height = 1000;
  const std::string why = failure([&] { render_image(scene, picture_grid(), options); });
  EXPECT_EQ(why.rfind("the host: out of memory: the picture needs ", 0), 0u) << why;
}

using CudaOnHostDeathTest = CudaOnHost;

TEST_F(CudaOnHostDeathTest, TheHostCannotTouchTheDevicesMemory) {
  const std::vector<int> values = {1, 2, 3};
  const DeviceBuffer<int> buffer = upload(std::span(values), "values");
  std::vector<int> back(3);
  copy_to_host(back.data(), buffer.data(), sizeof(int) * back.size());
  EXPECT_EQ(back, values);
  EXPECT_DEATH(static_cast<void>(*static_cast<volatile int*>(buffer.data())), "");
}

void trace(const DeviceScene& scene) {
  std::vector<Ray> rays;
  TestRays make(picture_grid(), 1);
  for (int i = 0; i < 100; ++i) rays.push_back(make.make(RayKind::kGeneric));
  std::vector<Hit> hits(rays.size()), expected(rays.size());
  CudaTracer(scene, picture_grid()).trace(rays, hits);
  if (scene.view().layout == DeviceLayout::kCubes)
    expected = trace_cubes(*scene.host().esvo(), picture_grid(), rays);
  else
    trace_batch(scene.host(), picture_grid(), rays, expected);
  EXPECT_EQ(hits, expected);
}

RenderOptions small_picture() {
  RenderOptions options = pictures(1)[0].options;
  options.width = 20;
  options.height = 12;
  options.samples_per_pixel = 2;
  options.shadow_samples = 2 * kShadowRaysWithBeams;
  options.filter = FilterKind::kGuided;
  options.specular = {0.4f, 10};
  options.with_steps = true;
  return options;
}

void expect_picture(const DeviceScene& scene, const ViewSource* source) {
  const RenderOptions options = small_picture();
  const RenderedImage image = render_image(scene, picture_grid(), options, {}, source);
  const RenderedImage like =
      scene.view().layout == DeviceLayout::kCubes
          ? render_cubes(*scene.host().esvo(), picture_grid(), options, source)
          : render_image(scene.host(), picture_grid(), options, {}, source);
  EXPECT_EQ(image.radiance, like.radiance);
  EXPECT_EQ(image.depth, like.depth);
  EXPECT_EQ(image.steps, like.steps);
  EXPECT_EQ(image.rays, like.rays);
}
void render(const DeviceScene& scene) { expect_picture(scene, nullptr); }
void render_from_source(const DeviceScene& scene) {
  const PlaneSource plane;
  expect_picture(scene, &plane);
}

void measure(const DeviceScene& scene) {
  const RenderPlan plan(scene.host(), picture_grid(), small_picture());
  EXPECT_GT(TimedBeams(scene, plan.setup()).run(), 0);
  const TimedCasts casts(scene, std::vector<CastRay>(10));  // rays that miss
  EXPECT_GT(casts.any() + casts.closest(), 0);
  std::vector<std::uint8_t> hits(10, 1);
  casts.copy_hits(hits);
  EXPECT_EQ(hits, std::vector<std::uint8_t>(10, 0));
}

/// Calls body(work) for each kind of work of a device and each kind of voxels.
template <class Body>
void for_all_work(const Body& body) {
  const Svdag dag = picture_scene();
  std::mt19937 rng(4);
  const Esvo esvo = TestEsvoAssembler(3, 4).assemble(*random_octree(rng, 0, 6), 6);
  for (void (*const work)(const DeviceScene&) : {trace, render, render_from_source, measure}) {
    body([&] { work(DeviceScene(choose_cuda_device(), dag.view())); });
    body([&] { work(DeviceScene(choose_cuda_device(), dag.view(), DeviceLayout::kTop)); });
    body([&] { work(DeviceScene(choose_cuda_device(), esvo.view())); });
    body([&] { work(DeviceScene(choose_cuda_device(), esvo.view(), DeviceLayout::kCubes)); });
  }
}

TEST_F(CudaOnHost, StreamsMayRunAtOnce) {
  host_device().is_eager = true;
  for_all_work([](const auto& work) { work(); });
}

/// Expects `work` to throw if any of its calls of the runtime fails, to release everything, and to
/// succeed afterwards.
template <class Work>
void expect_clean_failures(const Work& work) {
  int failing = 0, errors = 0;
  for (;; ++failing) {
    host_device().failing_call = failing;
    const std::string why = failure(work);
    if (host_device().failing_call) break;  // the work has fewer calls
    // The result of a wait before a queue is destroyed is ignored.
    EXPECT_TRUE(why.empty() || why.find("unknown error") != std::string::npos)
        << "call " << failing << ": " << why;
    ASSERT_TRUE(host_device().holds_nothing()) << "call " << failing << ": " << why;
    errors += why.empty() ? 0 : 1;
  }
  EXPECT_GT(errors, 20);
  EXPECT_LT(failing - errors, 6);
  host_device().failing_call.reset();
  work();
}

TEST_F(CudaOnHost, ACallThatFailsIsAnErrorThatLeavesNothingBehind) {
  for_all_work([](const auto& work) { expect_clean_failures(work); });
}

/// Streams a small picture, and expects it to equal the CPU's.
class StreamedWork : private WavyFile {
 public:
  StreamedWork() {
    options.width = 20;
    options.height = 12;
    options.samples_per_pixel = 1;
    options.with_steps = true;
    picture_ = whole();
  }
  void run(std::uint64_t most_bytes) const {
    StreamBlocks blocks(path(), std::max(most_bytes, least_memory(EsvoStream(path(), bytes))));
    DeviceStream stream(choose_cuda_device(), blocks);
    test::expect_same_picture(render_streamed(stream, grid, options), picture_);
  }
  std::uint64_t file_bytes() const { return bytes; }

 private:
  RenderedImage picture_;
};

TEST_F(CudaOnHost, AStreamedPictureMayRunAtOnceAndFailAnywhere) {
  const StreamedWork work;
  host_device().is_eager = true;
  for (const std::uint64_t memory : {work.file_bytes(), std::uint64_t{0}}) work.run(memory);
  host_device().is_eager = false;
  expect_clean_failures([&] { work.run(work.file_bytes()); });
}

TEST_F(CudaOnHost, BlocksThatTheDeviceHasNoRoomForSayHowMuchIsNeeded) {
  const StreamedWork work;
  host_device().memory_bytes = 1 << 16;
  const std::string why = failure([&] { work.run(work.file_bytes()); });
  EXPECT_EQ(why.rfind("the host: out of memory: the memory for blocks needs ", 0), 0u) << why;
}

}  // namespace
}  // namespace voxdag
