#include "voxdag/image/mip_pyramid.hpp"

#include <gtest/gtest.h>

#include <random>

#include "voxdag/formats/scenes/stone_heights.hpp"

namespace voxdag {
namespace {

using Grey = MipPyramid<1>;

Grey random_texture(int width, int height, TextureWrap wrap = TextureWrap::kRepeat,
                    std::uint32_t seed = 1) {
  std::mt19937 rng(seed);
  Grey::Texels texels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (Grey::Texel& texel : texels) texel[0] = static_cast<std::uint16_t>(rng() >> 16);
  return Grey(width, height, std::move(texels), wrap, wrap);
}

/// A parallelogram around a centre, spanned by two sides.
struct Parallelogram {
  Vec2f center, a, b;

  UvRegion region() const {
    return {center, (a.x * a.x + b.x * b.x) / 12, (a.x * a.y + b.x * b.y) / 12,
            (a.y * a.y + b.y * b.y) / 12};
  }
  template <class Body>
  void for_each_point(int side, const Body& body) const {
    for (int i = 0; i < side; ++i)
      for (int j = 0; j < side; ++j)
        body(center + a * ((static_cast<float>(i) + 0.5f) / static_cast<float>(side) - 0.5f) +
             b * ((static_cast<float>(j) + 0.5f) / static_cast<float>(side) - 0.5f));
  }
  double mean(const Grey& texture) const {
    double sum = 0;
    for_each_point(128, [&](Vec2f p) { sum += static_cast<double>(texture.sample(0, p)[0]); });
    return sum / (128 * 128);
  }
};

std::vector<Parallelogram> random_regions(int count, float size, float stretch) {
  std::mt19937 rng(7);
  std::uniform_real_distribution<float> unit(0, 1);
  std::vector<Parallelogram> regions;
  for (int i = 0; i < count; ++i) {
    const float angle = 6.2831853f * unit(rng), width = size * (0.5f + unit(rng));
    const Vec2f along{std::cos(angle), std::sin(angle)};
    regions.push_back({{4 * unit(rng) - 2, 4 * unit(rng) - 2},
                       along * (width * stretch),
                       Vec2f{-along.y, along.x} * width});
  }
  return regions;
}

TEST(MipPyramid, LevelsOfOddSizesKeepTheMean) {
  const Grey texture = random_texture(37, 23);
  ASSERT_EQ(texture.level_count(), 6);  // 37 18 9 4 2 1
  double mean = 0;
  for (int y = 0; y < 23; ++y)
    for (int x = 0; x < 37; ++x)
      mean += static_cast<double>(texture.sample(
          0, {(static_cast<float>(x) + 0.5f) / 37, (static_cast<float>(y) + 0.5f) / 23})[0]);
  mean /= 37 * 23;
  // Each level rounds to whole numbers.
  EXPECT_NEAR(static_cast<double>(texture.sample(5, {0.3f, 0.9f})[0]), mean, 3);
}

TEST(MipPyramid, SmallRegionsHaveTheBilinearValue) {
  const Grey texture = random_texture(16, 16);
  for (const Parallelogram& p : random_regions(200, 0.002f, 1))
    EXPECT_NEAR(texture.mean(p.region())[0], texture.sample(0, p.center)[0], 1e-3f);
}

TEST(MipPyramid, MeansOfRegionsAreNearThoseOfManySamples) {
  // The means of regions of n texels of white noise differ by 0.29 / sqrt(n). Only the texels of
  // the region itself determine its mean, so the filter's error must be smaller than that.
  const Grey noise = random_texture(256, 256);
  const Grey stones = make_stone_heights(3, 256);
  for (const float size : {2.0f, 5.0f, 13.0f, 30.0f})
    for (const float stretch : {1.0f, 3.0f, 8.0f}) {
      double noise_error = 0, stone_error = 0;
      constexpr int kCount = 100;
      for (const Parallelogram& p : random_regions(kCount, size / 256, stretch)) {
        noise_error +=
            std::pow((static_cast<double>(noise.mean(p.region())[0]) - p.mean(noise)) / 65535, 2);
        stone_error +=
            std::pow((static_cast<double>(stones.mean(p.region())[0]) - p.mean(stones)) / 65535, 2);
      }
      const double spread = 0.29 / std::sqrt(static_cast<double>(size * size * stretch));
      EXPECT_LT(std::sqrt(noise_error / kCount), 0.85 * spread) << size << " x " << stretch;
      EXPECT_LT(std::sqrt(stone_error / kCount), 0.03) << size << " x " << stretch;
    }
}

TEST(MipPyramid, TheMeanOfALargeRegionIsTheMeanOfTheImage) {
  const Grey texture = random_texture(64, 64);
  const float mean = texture.sample(6, {0.5f, 0.5f})[0];
  for (const Parallelogram& p : random_regions(50, 30, 4))
    EXPECT_NEAR(texture.mean(p.region())[0], mean, 0.01f * 65535);
}

TEST(MipPyramid, BoundsHoldEveryValueOfTheBox) {
  std::mt19937 rng(5);
  std::uniform_real_distribution<float> unit(0, 1);
  for (const TextureWrap wrap : {TextureWrap::kRepeat, TextureWrap::kMirror, TextureWrap::kClamp}) {
    const Grey texture = random_texture(37, 64, wrap);
    for (int i = 0; i < 400; ++i) {
      const float size = std::pow(2.0f, -8 * unit(rng)) * 1.5f;
      const Vec2f lo{4 * unit(rng) - 2, 4 * unit(rng) - 2};
      const Vec2f hi = lo + Vec2f{size * unit(rng), size * unit(rng)};
      const Grey::Bounds bounds = texture.bounds(lo, hi);
      for (int n = 0; n < 50; ++n) {
        const Vec2f p{lo.x + (hi.x - lo.x) * unit(rng), lo.y + (hi.y - lo.y) * unit(rng)};
        const float value = texture.sample(0, p)[0];
        EXPECT_GE(value, static_cast<float>(bounds.lo[0]) - 0.02f);
        EXPECT_LE(value, static_cast<float>(bounds.hi[0]) + 0.02f);
      }
    }
  }
}

TEST(MipPyramid, BoundsOfSmallBoxesAreTight) {
  // Between four neighbouring texels, only their four values count.
  Grey::Texels texels(64 * 64, {100});
  texels[40 * 64 + 40] = {60000};
  const Grey texture(64, 64, std::move(texels));
  const Grey::Bounds away = texture.bounds({0.1f, 0.1f}, {0.11f, 0.11f});
  EXPECT_EQ(away.hi[0], 100);
  const Grey::Bounds there = texture.bounds({40.4f / 64, 40.4f / 64}, {40.6f / 64, 40.6f / 64});
  EXPECT_EQ(there.hi[0], 60000);
}

TEST(MipPyramid, WrapModesContinueTheTextureAsNamed) {
  const auto at = [](TextureWrap wrap, float u) {
    const Grey texture(4, 1, {{0}, {100}, {200}, {300}}, wrap, wrap);
    return texture.sample(0, {u, 0.5f})[0];
  };
  EXPECT_FLOAT_EQ(at(TextureWrap::kRepeat, 1.125f), 0);
  EXPECT_FLOAT_EQ(at(TextureWrap::kRepeat, -0.125f), 300);
  EXPECT_FLOAT_EQ(at(TextureWrap::kRepeat, 1.0f), 150);
  EXPECT_FLOAT_EQ(at(TextureWrap::kMirror, 1.125f), 300);
  EXPECT_FLOAT_EQ(at(TextureWrap::kMirror, 1.875f), 0);
  EXPECT_FLOAT_EQ(at(TextureWrap::kMirror, -0.375f), 100);
  EXPECT_FLOAT_EQ(at(TextureWrap::kClamp, 7.0f), 300);
  EXPECT_FLOAT_EQ(at(TextureWrap::kClamp, -7.0f), 0);
}

TEST(MipPyramid, NotFiniteCoordinatesGiveSomeValue) {
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              infinity = std::numeric_limits<float>::infinity();
  for (const TextureWrap wrap : {TextureWrap::kRepeat, TextureWrap::kMirror, TextureWrap::kClamp}) {
    const Grey texture = random_texture(8, 8, wrap);
    for (const float x : {nan, infinity, -infinity, 3e38f}) {
      EXPECT_GE(texture.sample(0, {x, 0.5f})[0], 0);
      EXPECT_GE(texture.mean({{x, x}, 1, 0, 1})[0], 0);
      EXPECT_GE(texture.mean({{0, 0}, x, x, x})[0], 0);
      const Grey::Bounds bounds = texture.bounds({-x, -x}, {x, x});
      EXPECT_LE(bounds.lo[0], bounds.hi[0]);
    }
  }
}

}  // namespace
}  // namespace voxdag
