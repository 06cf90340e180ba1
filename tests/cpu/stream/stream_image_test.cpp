// Tests pictures of an ESVO whose blocks are loaded during rendering.
#include <gtest/gtest.h>

#include "support/picture_checks.hpp"
#include "support/wavy_file.hpp"
#include "voxdag/cpu/stream/paged_cells.hpp"
#include "voxdag/render/coarse_cells.hpp"

namespace voxdag {
namespace {

class StreamImage : public testing::Test, protected WavyFile {};

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

TEST_F(StreamImage, IsTheSameInLessMemoryThanItsBlocksNeed) {
  StreamBlocks all(path(), bytes);
  render_streamed(all, all.stream().grid(), options);
  const std::uint64_t needed = all.stream().counts().bytes_loaded;

  StreamBlocks blocks(path(), needed / 2);
  const RenderedImage image = render_streamed(blocks, blocks.stream().grid(), options);
  EXPECT_GT(blocks.stream().counts().blocks_evicted, 0u);
  EXPECT_LE(blocks.stream().counts().bytes_loaded, needed / 2);
  test::expect_same_picture(image, whole());
}

TEST_F(StreamImage, FiltersAsThePictureOfTheWholeOctree) {
  StreamBlocks blocks(path(), bytes);
  for (const FilterKind kind : {FilterKind::kNaive, FilterKind::kPlain, FilterKind::kGuided}) {
    options.filter = kind;
    test::expect_same_picture(render_streamed(blocks, blocks.stream().grid(), options), whole());
  }
}

TEST_F(StreamImage, HasTheHighlightsOfTheWholeOctree) {
  StreamBlocks blocks(path(), bytes);
  const RenderedImage dull = whole();
  options.specular = {0.4f, 10};
  const RenderedImage image = render_streamed(blocks, blocks.stream().grid(), options);
  test::expect_same_picture(image, whole());
  EXPECT_NE(image.radiance, dull.radiance);
}

TEST_F(StreamImage, HasTheSectionOfTheWholeOctree) {
  StreamBlocks blocks(path(), bytes);
  const RenderedImage uncut = whole();
  const Grid& place = blocks.stream().grid();
  options.section.plane = {place.origin + Vec3d{1, 1, 1} * (0.5 * place.side()), {0.3, -1, 0.2}};
  const RenderedImage image = render_streamed(blocks, blocks.stream().grid(), options);
  test::expect_same_picture(image, whole());
  EXPECT_NE(image.depth, uncut.depth);
}

/// Renders these pictures one after the other, with memory for `bytes` of blocks. Returns the bytes
/// of the blocks that are loaded at the end.
std::uint64_t bytes_for(const std::filesystem::path& path, std::uint64_t bytes,
                        const std::vector<RenderOptions>& pictures) {
  StreamBlocks blocks(path, bytes);
  for (const RenderOptions& picture : pictures)
    render_streamed(blocks, blocks.stream().grid(), picture);
  return blocks.stream().counts().bytes_loaded;
}

TEST_F(StreamImage, APictureUsesTheBlocksOfTheOneBefore) {
  StreamBlocks blocks(path(), bytes);
  render_streamed(blocks, blocks.stream().grid(), options);
  const std::uint64_t read = blocks.stream().counts().blocks_read;
  test::expect_same_picture(render_streamed(blocks, blocks.stream().grid(), options), whole());
  EXPECT_EQ(blocks.stream().counts().blocks_read, read) << "all that it needs is there";
  options.view.eye = Vec3d{1.2, 0.4, 0.9};
  test::expect_same_picture(render_streamed(blocks, blocks.stream().grid(), options), whole());
  const EsvoStreamCounts& counts = blocks.stream().counts();
  EXPECT_GT(counts.blocks_read, read);
  EXPECT_EQ(counts.blocks_read, counts.blocks_used) << "none is read twice";
}

TEST_F(StreamImage, APictureReplacesTheBlocksOfEarlierOnes) {
  // The cameras are near the surface, so that each view needs few of the other's blocks.
  options.occlusion_samples = 0;
  options.shadows = false;
  std::vector<RenderOptions> pictures(2, options);
  pictures[0].view.eye = Vec3d{0.1, 0.4, 0.1};
  pictures[0].view.target = Vec3d{0.15, 0.1, 0.15};
  pictures[1].view.eye = Vec3d{0.9, 0.4, 0.9};
  pictures[1].view.target = Vec3d{0.85, 0.1, 0.85};
  const std::uint64_t one =
      std::max(bytes_for(path(), bytes, {pictures[0]}), bytes_for(path(), bytes, {pictures[1]}));
  const std::uint64_t memory = one + one / 8;
  ASSERT_GT(bytes_for(path(), bytes, pictures), memory);

  StreamBlocks blocks(path(), memory);
  for (int i = 0; i < 6; ++i) {
    options = pictures[static_cast<std::size_t>(i % 2)];
    int passes = 0;
    const RenderedImage image = render_streamed(blocks, blocks.stream().grid(), options,
                                                [&](const RenderedImage&) { ++passes; });
    // Blocks are loaded level by level, for all tiles together. Without room, after a pass or two
    // they are loaded for one tile after the other.
    EXPECT_GT(passes, 3);
    test::expect_same_picture(image, whole());
  }
  const EsvoStreamCounts& counts = blocks.stream().counts();
  EXPECT_GT(counts.blocks_evicted, 0u);
  EXPECT_LE(counts.bytes_loaded, memory);
  EXPECT_LE(counts.bytes_read, 6 * one) << "no picture reads a block twice";
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

TEST_F(StreamImage, CellsAreThoseOfTheWholeOctreeInAnyMemory) {
  const EsvoFile file(path());
  const EsvoStream probe(path(), bytes);
  for (const int level : {2, kUpLevel, 9}) {
    const std::vector<Vec3i> cells = CoarseCells(file.view(), level).cells();
    for (const std::uint64_t memory : {bytes, least_memory(probe)}) {
      StreamBlocks blocks(path(), memory);
      EXPECT_EQ(CoarseCells::of(PagedCells(blocks), level).cells(), cells);
      if (level == kUpLevel) {
        EXPECT_LT(blocks.stream().counts().blocks_used, probe.directory().size() / 2);
      }
    }
  }
}

TEST_F(StreamImage, LessMemoryThanABlockTakesIsAnError) {
  const EsvoStream probe(path(), bytes);
  EXPECT_THROW(StreamBlocks(path(), least_memory(probe) - 1), Error);
}

}  // namespace
}  // namespace voxdag
