#include "voxdag/builders/esvo/encode/encode_color_block.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace voxdag {
namespace {

using Colors = std::array<Vec3f, kValuesPerBlock>;

double squared_error(const Colors& colors, std::uint32_t used, ColorBlock block,
                     const float* weights = nullptr) {
  double sum = 0;
  for (int i = 0; i < kValuesPerBlock; ++i) {
    if ((used >> i & 1u) == 0) continue;
    const Vec3d d = Vec3d(block.color(i)) - Vec3d(colors[static_cast<std::size_t>(i)]);
    sum += dot(d, d) * (weights != nullptr ? static_cast<double>(weights[i]) : 1.0);
  }
  return sum;
}

/// Returns the least sum of squared differences in a channel of `steps` steps, over all pairs of
/// ends.
double best_channel(const std::vector<double>& values, const std::vector<int>& thirds, int steps) {
  double best = std::numeric_limits<double>::infinity();
  for (int p = 0; p <= steps; ++p)
    for (int q = 0; q <= steps; ++q) {
      double sum = 0;
      for (std::size_t i = 0; i < values.size(); ++i) {
        const double d = (thirds[i] * p + (3 - thirds[i]) * q) / (3.0 * steps) - values[i];
        sum += d * d;
      }
      best = std::min(best, sum);
    }
  return best;
}

/// Returns the least error of any block: tries all selectors, and for each all ends.
double optimum(const std::vector<Vec3f>& colors) {
  double best = std::numeric_limits<double>::infinity();
  std::vector<int> thirds(colors.size());
  for (unsigned code = 0; code < 1u << (2 * colors.size()); ++code) {
    for (std::size_t i = 0; i < thirds.size(); ++i)
      thirds[i] = static_cast<int>(code >> (2 * i) & 3u);
    if (thirds[0] < 2) continue;  // The same block with exchanged ends was tried.
    double sum = 0;
    for (int c = 0; c < 3 && sum < best; ++c) {
      std::vector<double> channel;
      for (const Vec3f& color : colors) channel.push_back(static_cast<double>(color[c]));
      sum += best_channel(channel, thirds, c == 1 ? 63 : 31);
    }
    best = std::min(best, sum);
  }
  return best;
}

Vec3f random_color(std::mt19937& random) {
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  return {unit(random), unit(random), unit(random)};
}

/// Returns colours within `spread` of a random colour, in [0,1].
Colors random_colors(std::mt19937& random, float spread) {
  const Vec3f center = random_color(random);
  Colors colors;
  for (Vec3f& color : colors) {
    color = center + (random_color(random) - Vec3f{0.5f, 0.5f, 0.5f}) * (2.0f * spread);
    color = max(min(color, Vec3f{1, 1, 1}), Vec3f{0, 0, 0});
  }
  return colors;
}

TEST(EncodeColorBlock, NothingUsedGivesZeroBits) {
  EXPECT_EQ(encode_color_block(Colors{}, 0).bits, 0u);
}

TEST(EncodeColorBlock, OneColourIsWithinAThirdOfAStep) {
  std::mt19937 random(1);
  for (int i = 0; i < 2000; ++i) {
    Colors colors;
    colors.fill(random_color(random));
    const Vec3f decoded = encode_color_block(colors, 0xFFFF).color(7);
    EXPECT_LE(std::abs(decoded.x - colors[0].x), 0.5f / 93.0f + 1e-6f);
    EXPECT_LE(std::abs(decoded.y - colors[0].y), 0.5f / 189.0f + 1e-6f);
    EXPECT_LE(std::abs(decoded.z - colors[0].z), 0.5f / 93.0f + 1e-6f);
  }
}

TEST(EncodeColorBlock, BlackWhiteAndTheStepsAreExact) {
  for (const Vec3f color : {Vec3f{0, 0, 0}, Vec3f{1, 1, 1}, Vec3f{1, 0, 0},
                            Vec3f{7.0f / 31.0f, 44.0f / 63.0f, 20.0f / 31.0f}}) {
    Colors colors;
    colors.fill(color);
    const Vec3f decoded = encode_color_block(colors, 0x0101).color(8);
    for (int c = 0; c < 3; ++c) EXPECT_FLOAT_EQ(decoded[c], color[c]);
  }
}

TEST(EncodeColorBlock, BlackBesideWhiteIsExact) {
  Colors colors;
  for (std::size_t i = 0; i < colors.size(); i += 3) colors[i] = {1, 1, 1};
  EXPECT_EQ(squared_error(colors, 0xFFFF, encode_color_block(colors, 0xFFFF)), 0.0);
}

TEST(EncodeColorBlock, ValuesOfABlockAreEncodedExactly) {
  // All four selectors used, between ends far apart.
  std::mt19937 random(2);
  for (int round = 0; round < 500; ++round) {
    const auto end = [&random](int low) {
      return Rgb565{static_cast<int>(random() % 8) + low / 2, static_cast<int>(random() % 16) + low,
                    static_cast<int>(random() % 8) + low / 2};
    };
    const ColorBlock block =
        ColorBlock::pack(end(0), end(40), (static_cast<std::uint32_t>(random()) & ~0xFFu) | 0xE4u);
    Colors colors;
    for (int i = 0; i < kValuesPerBlock; ++i) colors[static_cast<std::size_t>(i)] = block.color(i);
    EXPECT_LT(squared_error(colors, 0xFFFF, encode_color_block(colors, 0xFFFF)), 1e-9);
  }
}

TEST(EncodeColorBlock, IsNearTheOptimumOfFourColours) {
  std::mt19937 random(3);
  for (const float spread : {0.02f, 0.1f, 0.5f}) {
    double ours = 0, best = 0;
    for (int round = 0; round < 12; ++round) {
      const Colors colors = random_colors(random, spread);
      ours += squared_error(colors, 0x8421, encode_color_block(colors, 0x8421));
      best += optimum({colors[0], colors[5], colors[10], colors[15]});
    }
    EXPECT_GE(ours, best * (1 - 1e-5));
    EXPECT_LE(ours, best * 1.25) << "spread " << spread;
  }
}

TEST(EncodeColorBlock, IsNearTheOptimumOfTwoAndThreeColours) {
  std::mt19937 random(4);
  for (const std::uint32_t used : {0x0300u, 0x0700u})
    for (const float spread : {0.02f, 0.3f}) {
      double ours = 0, best = 0;
      for (int round = 0; round < 40; ++round) {
        const Colors colors = random_colors(random, spread);
        ours += squared_error(colors, used, encode_color_block(colors, used));
        std::vector<Vec3f> few = {colors[8], colors[9]};
        if (used == 0x0700u) few.push_back(colors[10]);
        best += optimum(few);
      }
      EXPECT_LE(ours, best * 1.25) << "used " << used << " spread " << spread;
    }
}

TEST(EncodeColorBlock, UnusedValuesDoNotMatter) {
  std::mt19937 random(5);
  for (int round = 0; round < 200; ++round) {
    const auto used = static_cast<std::uint32_t>(random() & 0xFFFFu);
    Colors colors = random_colors(random, 0.3f);
    const ColorBlock block = encode_color_block(colors, used);
    for (std::size_t i = 0; i < colors.size(); ++i)
      if ((used >> i & 1u) == 0) colors[i] = {NAN, -7.0f, 1e30f};
    EXPECT_EQ(encode_color_block(colors, used), block);
  }
}

TEST(EncodeColorBlock, WeightsOfOneChangeNothing) {
  std::mt19937 random(6);
  const std::vector<float> ones(16, 1.0f);
  for (int round = 0; round < 50; ++round) {
    const Colors colors = random_colors(random, 0.3f);
    EXPECT_EQ(encode_color_block(colors, 0x5AF3, ones.data()), encode_color_block(colors, 0x5AF3));
  }
}

TEST(EncodeColorBlock, ValuesWithMoreWeightAreCloser) {
  std::mt19937 random(7);
  std::vector<float> weights(16, 1.0f);
  weights[3] = weights[9] = 200.0f;
  double heavy = 0, plain = 0;
  for (int round = 0; round < 50; ++round) {
    const Colors colors = random_colors(random, 0.4f);
    heavy += squared_error(colors, 0x0208, encode_color_block(colors, 0xFFFF, weights.data()));
    plain += squared_error(colors, 0x0208, encode_color_block(colors, 0xFFFF));
  }
  EXPECT_LT(heavy, plain / 3);
}

TEST(EncodeColorBlock, ColoursOutsideTheRangeAreClamped) {
  Colors colors;
  colors.fill({2.0f, -1.0f, NAN});
  EXPECT_EQ(encode_color_block(colors, 0xFFFF).color(0), (Vec3f{1, 0, 0}));
}

TEST(EncodeColorBlock, TheBitsAreTheSameOnEveryMachine) {
  // Computes FNV-1a over blocks of all kinds.
  std::mt19937 random(8);
  std::uint64_t hash = 0xCBF29CE484222325ull;
  for (int round = 0; round < 2000; ++round) {
    Colors colors;
    for (Vec3f& color : colors)
      for (int c = 0; c < 3; ++c)
        color[c] = static_cast<float>(random() >> (8 + round % 3) & 0xFFFFu) / 65536.0f;
    const auto used = static_cast<std::uint32_t>(random() & 0xFFFFu);
    hash = (hash ^ encode_color_block(colors, used).bits) * 0x100000001B3ull;
  }
  EXPECT_EQ(hash, 14172533317529871466u) << "changes with the encoder, not with the machine";
}

}  // namespace
}  // namespace voxdag
