// Pictures of an ESVO that is loaded while they are made.
#include <gtest/gtest.h>

#include "support/grid_mesh.hpp"
#include "support/picture_checks.hpp"
#include "support/temp_dir.hpp"
#include "voxdag/esvo/build_esvo.hpp"
#include "voxdag/file/esvo_file.hpp"
#include "voxdag/file/esvo_writer.hpp"
#include "voxdag/stream/stream_blocks.hpp"

namespace voxdag {
namespace {

/// Waves of some thousand triangles.
Mesh waves(int n) {
  return test::grid_mesh(n, [n](int i, int j) {
    const float x = static_cast<float>(i) / static_cast<float>(n);
    const float z = static_cast<float>(j) / static_cast<float>(n);
    return Vec3f{x, 0.2f + 0.1f * std::sin(20 * x) * std::cos(17 * z), z};
  });
}

class StreamImage : public testing::Test {
 protected:
  StreamImage() {
    const Mesh mesh = waves(60);
    EsvoOptions build;
    build.settings.max_error = 0.1f;
    build.settings.normal_error = 0.001f;
    build.pack.max_slots = 200;
    EsvoMemory memory;
    EsvoMetadata metadata;
    metadata.grid = fit_grid(mesh, 9);
    EsvoResult result = build_esvo(mesh, metadata.grid, build, nullptr, nullptr, memory);
    metadata.root = result.root;
    metadata.counts = result.counts;
    EsvoFileWriter writer(path());
    const std::vector<std::uint64_t> slots = memory.take();
    bytes = slots.size() * 8;
    writer.append(slots);
    writer.finish(std::move(result.directory), metadata);
    options.width = 96;
    options.height = 64;
    options.occlusion_samples = 4;
    options.shadow_samples = 2;
    options.view.eye = Vec3d{0.5, 0.5, -0.2};
    options.view.target = Vec3d{0.5, 0.15, 0.4};
  }
  std::filesystem::path path() const { return dir / "waves.esvo"; }
  RenderedImage whole() const {
    const EsvoFile file(path());
    return render_image(file.view(), file.grid(), options);
  }
  TempDir dir;
  std::uint64_t bytes = 0;
  RenderOptions options;
};

TEST_F(StreamImage, IsThePictureOfTheWholeOctree) {
  StreamBlocks blocks(path(), bytes);
  ASSERT_GT(blocks.stream().directory().size(), 20u);
  int passes = 0;
  const RenderedImage image =
      render_streamed(blocks, blocks.stream().grid(), options, [&](const RenderedImage& pass) {
        ++passes;
        EXPECT_EQ(pass.rgb.size(), 96u * 64u);
      });
  EXPECT_GT(passes, 0) << "something coarse is there first";
  test::expect_same_picture(image, whole());
  EXPECT_LT(blocks.stream().counts().bytes_loaded, bytes) << "what nobody sees is not loaded";
}

TEST_F(StreamImage, IsTheSameWithLessMemoryThanItsBlocksTake) {
  StreamBlocks all(path(), bytes);
  render_streamed(all, all.stream().grid(), options);
  const std::uint64_t needed = all.stream().counts().bytes_loaded;

  StreamBlocks blocks(path(), needed / 2);
  const RenderedImage image = render_streamed(blocks, blocks.stream().grid(), options);
  EXPECT_GT(blocks.stream().counts().blocks_evicted, 0u);
  EXPECT_LE(blocks.stream().counts().bytes_loaded, needed / 2);
  test::expect_same_picture(image, whole());
}

/// Of a block and those above it, at most.
std::uint64_t least_memory(const EsvoStream& stream) {
  std::uint64_t least = 0;
  for (std::size_t i = 0; i < stream.directory().size(); ++i) {
    std::uint64_t bytes = 0;
    for (auto at = static_cast<std::int64_t>(i); at >= 0;
         at = stream.parent(static_cast<std::size_t>(at)))
      bytes += stream.directory()[static_cast<std::size_t>(at)].slots * 8ull;
    least = std::max(least, bytes);
  }
  return least;
}

TEST_F(StreamImage, IsTheSameWhereOneBlockFitsAtATime) {
  const EsvoStream probe(path(), bytes);
  options.width = 48;
  options.height = 32;
  LightSpec lamp;
  lamp.kind = LightKind::kSphere;
  lamp.position = {0.5, 0.6, 0.4};
  lamp.radius = 0.1;
  lamp.color = {1, 1, 1};
  options.lights = {lamp};
  for (const int samples : {1, 2}) {
    options.samples_per_pixel = samples;
    StreamBlocks blocks(path(), least_memory(probe));
    const RenderedImage image = render_streamed(blocks, blocks.stream().grid(), options);
    EXPECT_GT(blocks.stream().counts().blocks_evicted, 100u);
    test::expect_same_picture(image, whole());
  }
}

TEST_F(StreamImage, LessMemoryThanABlockTakesIsAnError) {
  const EsvoStream probe(path(), bytes);
  EXPECT_THROW(StreamBlocks(path(), least_memory(probe) - 1), Error);
}

}  // namespace
}  // namespace voxdag
