// Compares casts that wait for missing blocks with casts at the whole octree.
#include "voxdag/trace/resumed_rays.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "support/test_rays.hpp"
#include "support/wavy_file.hpp"

namespace voxdag {
namespace {

constexpr std::uint32_t kCasts = 3;

/// The casts of a pixel: first one on which the others depend.
struct Pixel {
  GridRay rays[kCasts];
  StopBelowSize stop;
  bool first_is_hit = false;
  EsvoHit hit;
  bool is_hit[kCasts - 1] = {};
};

class ResumedRays : public testing::Test, protected WavyFile {
 protected:
  Pixel random_pixel(TestRays& rays, int kind) const {
    Pixel pixel;
    for (GridRay& ray : pixel.rays)
      ray = make_grid_ray(grid, rays.make(static_cast<RayKind>(kind)));
    if (kind % 2 == 0) pixel.stop = {0.03f, 0.1f, 2};
    return pixel;
  }

  /// Continues the pixel's casts, and returns whether any ray waits for a block.
  static bool go_on(const PartialEsvoView& esvo, std::uint8_t* wanted, std::uint32_t* states,
                    std::uint32_t& known, Pixel& pixel) {
    RayLog log(states, 1, known, kCasts);
    const ResumedNodes nodes(esvo, wanted, log);
    if (!log.skip_ended()) pixel.first_is_hit = cast(nodes, pixel.rays[0], pixel.stop, pixel.hit);
    ResumedCaster(nodes).any(
        kCasts - 1,
        [&](int i) {
          return CastRay{pixel.rays[1 + i], pixel.stop};
        },
        [&](int i, bool is_hit) { pixel.is_hit[i] = is_hit; });
    known = log.known();
    return log.has_missed();
  }

  /// Returns the wanted block that has the most ancestors.
  static std::size_t deepest(const std::vector<std::uint8_t>& wanted, const StreamBlocks& blocks) {
    std::size_t best = blocks.block_count();
    for (std::size_t i = 0; i < wanted.size(); ++i)
      if (wanted[i] != 0 && (best == blocks.block_count() || blocks.depth(i) > blocks.depth(best)))
        best = i;
    return best;
  }

  void expect_whole(const Pixel& pixel) const {
    const ContourNodes nodes(file.view());
    EsvoHit hit;
    const bool is_hit = cast(nodes, pixel.rays[0], pixel.stop, hit);
    ASSERT_EQ(pixel.first_is_hit, is_hit);
    if (is_hit) {
      EXPECT_EQ(pixel.hit.t, hit.t);
      EXPECT_EQ(pixel.hit.level, hit.level);
      EXPECT_EQ(pixel.hit.plane.contour.bits, hit.plane.contour.bits);
      EXPECT_TRUE(pixel.hit.x == hit.x && pixel.hit.y == hit.y && pixel.hit.z == hit.z);
    }
    for (std::uint32_t i = 1; i < kCasts; ++i)
      EXPECT_EQ(pixel.is_hit[i - 1], cast(nodes, pixel.rays[i], pixel.stop, hit));
  }

  const EsvoFile file{path()};
};

TEST_F(ResumedRays, HitWhatRaysAtTheWholeOctreeHitWhateverIsInMemory) {
  const EsvoStream probe(path(), bytes);
  const std::uint64_t least = least_memory(probe);
  for (const std::uint64_t memory : {least, 2 * least, bytes}) {
    StreamBlocks blocks(path(), memory);
    ASSERT_GT(blocks.block_count(), 40u);
    std::mt19937 random(5);
    TestRays rays(grid, 9);
    std::vector<std::uint8_t> wanted(blocks.block_count());
    int longest = 0;
    for (int i = 0; i < 2000; ++i) {
      Pixel pixel = random_pixel(rays, i % static_cast<int>(RayKind::kCount));
      std::uint32_t states[kCasts], known = 0;
      int rounds = 0;
      for (; go_on(blocks.loaded(), wanted.data(), states, known, pixel); ++rounds) {
        ASSERT_LT(rounds, 1000);
        const std::size_t block = deepest(wanted, blocks);
        for (int more = static_cast<int>(random() % 3); more > 0; --more)
          blocks.load(random() % blocks.block_count());
        blocks.load(block);
        std::fill(wanted.begin(), wanted.end(), std::uint8_t{0});
      }
      longest = std::max(longest, rounds);
      expect_whole(pixel);
    }
    EXPECT_GT(longest, memory < bytes ? 10 : 1) << memory;
  }
}

}  // namespace
}  // namespace voxdag
