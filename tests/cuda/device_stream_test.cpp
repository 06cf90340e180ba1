#include "voxdag/cuda/device_stream.hpp"

#include "cuda/cuda_device.hpp"
#include "cuda/like_the_cpu.hpp"
#include "support/error_of.hpp"
#include "support/picture_checks.hpp"
#include "support/wavy_file.hpp"

namespace voxdag {
namespace {

class CudaStreaming : public OnCudaDevice, protected WavyFile {
 protected:
  CudaStreaming() {
    options.filter = FilterKind::kGuided;
    LightSpec lamp;
    lamp.kind = LightKind::kSphere;
    lamp.position = {0.5, 0.6, 0.4};
    lamp.radius = 0.1;
    lamp.color = {1, 1, 1};
    options.lights = {lamp};
  }

  /// Expects the picture that the CPU makes of the whole octree: to the bit if the device's
  /// functions are the host's.
  void expect_whole(const RenderedImage& image) const {
    if (device_.name == "the host")
      test::expect_same_picture(image, whole());
    else
      expect_pixels_like(image, whole());
  }
  RenderedImage render(DeviceStream& stream,
                       const std::function<void(const RenderedImage&)>& on_pass = {},
                       Work work = {}) const {
    return render_streamed(stream, grid, options, on_pass, work);
  }
  std::uint64_t needed() const {
    StreamBlocks blocks(path(), bytes);
    render_streamed(blocks, grid, options);
    return blocks.stream().counts().bytes_loaded;
  }
};

TEST_F(CudaStreaming, IsThePictureOfTheWholeOctree) {
  StreamBlocks blocks(path(), bytes);
  DeviceStream stream(device_, blocks);
  int passes = 0;
  const RenderedImage image = render(stream, [&](const RenderedImage& pass) {
    ++passes;
    EXPECT_EQ(pass.rgb.size(), 96u * 64u);
  });
  EXPECT_GT(passes, 0) << "something coarse is there first";
  expect_whole(image);
  EXPECT_LT(blocks.stream().counts().bytes_loaded, bytes) << "what nobody sees is not loaded";
}

TEST_F(CudaStreaming, IsThatPictureInAnyMemory) {
  options.width = 48;
  options.height = 32;
  const EsvoStream probe(path(), bytes);
  const std::uint64_t least = least_memory(probe), all = needed();
  for (const std::uint64_t memory : {all, all / 2, all / 4, 2 * least, least}) {
    SCOPED_TRACE(memory);
    StreamBlocks blocks(path(), std::max(memory, least));
    DeviceStream stream(device_, blocks);
    expect_whole(render(stream));
    const EsvoStreamCounts& counts = blocks.stream().counts();
    EXPECT_LE(counts.bytes_loaded, std::max(memory, least));
    EXPECT_EQ(counts.blocks_evicted > 0, memory < all);
  }
}

TEST_F(CudaStreaming, IsThatPictureForManySamplesBeamsToLightsAndNoBeams) {
  options.width = 40;
  options.height = 24;
  const EsvoStream probe(path(), bytes);
  for (const bool beams : {true, false})
    for (const std::uint64_t memory : {bytes, 4 * least_memory(probe), least_memory(probe)}) {
      options.beams = beams;
      options.samples_per_pixel = 2;
      options.shadow_samples = 128;
      options.with_steps = true;
      StreamBlocks blocks(path(), memory);
      DeviceStream stream(device_, blocks);
      const RenderedImage image = render(stream);
      expect_whole(image);
      EXPECT_EQ(image.steps.size(), 40u * 24u);
      for (const float steps : image.steps) EXPECT_GE(steps, 0);
    }
}

TEST_F(CudaStreaming, APictureUsesTheBlocksOfTheOneBefore) {
  StreamBlocks blocks(path(), bytes);
  DeviceStream stream(device_, blocks);
  render(stream);
  const std::uint64_t read = blocks.stream().counts().blocks_read;
  expect_whole(render(stream));
  EXPECT_EQ(blocks.stream().counts().blocks_read, read) << "all that it needs is there";
  options.view.eye = Vec3d{1.2, 0.4, 0.9};
  expect_whole(render(stream));
  const EsvoStreamCounts& counts = blocks.stream().counts();
  EXPECT_GT(counts.blocks_read, read);
  EXPECT_EQ(counts.blocks_read, counts.blocks_used) << "none is read twice";
}

TEST_F(CudaStreaming, SeesTheBlocksThatTheCpuLoadedOrDropped) {
  const std::uint64_t memory = needed() / 2;
  StreamBlocks blocks(path(), memory);
  DeviceStream stream(device_, blocks);
  for (int i = 0; i < 3; ++i) {
    options.view.eye = Vec3d{0.3 + 0.2 * i, 0.5, -0.2};
    expect_whole(render(stream));
    test::expect_same_picture(render_streamed(blocks, grid, options), whole());
  }
}

TEST_F(CudaStreaming, ADamagedBlockIsNamed) {
  std::string text = read_text(path());
  const EsvoStream probe(path(), bytes);
  for (const EsvoBlockEntry& block : probe.directory())
    if (block.parent != EsvoBlockEntry::kNoParent) text[256 + block.begin * 8 + 4000] ^= 1;
  write_text(path(), text);
  StreamBlocks blocks(path(), bytes);
  DeviceStream stream(device_, blocks);
  for (int run = 0; run < 2; ++run) {
    const std::string why = error_of([&] { render(stream); });
    EXPECT_NE(why.find("waves.esvo: block "), std::string::npos) << why;
    EXPECT_NE(why.find("checksum is wrong"), std::string::npos) << why;
  }
}

TEST_F(CudaStreaming, StopsWhenCancelledAndWorksAgain) {
  options.width = 48;
  options.height = 32;
  const EsvoStream probe(path(), bytes);
  for (const std::uint64_t memory : {bytes, least_memory(probe)}) {
    StreamBlocks blocks(path(), memory);
    DeviceStream stream(device_, blocks);
    Progress cancelled;
    cancelled.cancel();
    EXPECT_THROW(render(stream, {}, &cancelled), Cancelled);
    Progress later([&](std::string_view stage, double fraction, std::uint64_t) {
      if (memory == bytes || (stage == "stream" && fraction > 0.5)) later.cancel();
    });
    EXPECT_THROW(render(stream, {}, &later), Cancelled);
    expect_whole(render(stream));
  }
}

}  // namespace
}  // namespace voxdag
