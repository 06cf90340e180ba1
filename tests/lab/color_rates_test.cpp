#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "lab/attributes/dolonius.hpp"

namespace voxdag::lab {
namespace {

using Colors = std::vector<ColorBytes>;

ColorBytes bytes(int r, int g, int b) {
  return static_cast<ColorBytes>(r) | static_cast<ColorBytes>(g) << 8 |
         static_cast<ColorBytes>(b) << 16;
}

/// Smooth colors with noise, as along a surface.
Colors smooth_colors(std::size_t count, int noise, unsigned seed) {
  std::mt19937 random(seed);
  const auto channel = [&](double phase, std::size_t i) {
    const double wave = 127 + 100 * std::sin(phase + static_cast<double>(i) * 0.01);
    return std::clamp(static_cast<int>(wave) + static_cast<int>(random() % (2 * noise + 1)) - noise,
                      0, 255);
  };
  Colors colors;
  for (std::size_t i = 0; i < count; ++i)
    colors.push_back(bytes(channel(0, i), channel(0.3, i), channel(1.1, i)));
  return colors;
}

std::uint64_t part(const EncodedColors& encoded, const std::string& name) {
  for (const SizePart& part : encoded.size.parts)
    if (part.name == name) return part.bytes;
  ADD_FAILURE() << name;
  return 0;
}

TEST(Dolonius, OneColorTakesOneBlockAMacroBlock) {
  const Colors colors(16384 + 100, bytes(200, 100, 50));
  const EncodedColors encoded = encode_dolonius(colors, 0.01f, Progress());
  EXPECT_EQ(part(encoded, "block headers"), 4u * 2);
  EXPECT_EQ(part(encoded, "end points"), 4u * 2);
  EXPECT_EQ(part(encoded, "weights"), 0u);
  EXPECT_EQ(part(encoded, "macro blocks"), 16u * 2);
  EXPECT_EQ(encoded.colors, colors);
}

TEST(Dolonius, TwoColorsTakeOneBitEach) {
  Colors colors;
  for (int i = 0; i < 1000; ++i)
    colors.push_back(i % 2 == 0 ? bytes(0, 0, 0) : bytes(255, 255, 255));
  const EncodedColors encoded = encode_dolonius(colors, 0.01f, Progress());
  EXPECT_EQ(part(encoded, "block headers"), 4u);
  EXPECT_EQ(part(encoded, "weights"), 4u * 32);  // 1000 bits, whole words
  EXPECT_EQ(encoded.colors, colors);
}

// Black and white in front of gray: weights of one bit for the first only.
TEST(Dolonius, BlocksHaveTheBitsThatTheyNeed) {
  Colors colors;
  for (int i = 0; i < 320; ++i)
    colors.push_back(i % 2 == 0 ? bytes(0, 0, 0) : bytes(255, 255, 255));
  colors.resize(5000, bytes(128, 128, 128));
  const EncodedColors encoded = encode_dolonius(colors, 0.01f, Progress());
  EXPECT_EQ(part(encoded, "block headers"), 4u * 2);
  EXPECT_EQ(part(encoded, "weights"), 4u * 10);
  EXPECT_EQ(encoded.colors, colors);
}

TEST(Dolonius, NoErrorIsAboveTheThreshold) {
  for (const float threshold : {0.02f, 0.05f, 0.2f})
    for (const int noise : {0, 4, 30}) {
      const Colors colors = smooth_colors(20000, noise, 3);
      const EncodedColors encoded = encode_dolonius(colors, threshold, Progress());
      ASSERT_EQ(encoded.colors.size(), colors.size());
      float largest = 0;
      for (std::size_t i = 0; i < colors.size(); ++i)
        largest = std::max(
            largest, color_error(color_of_bytes(colors[i]), color_of_bytes(encoded.colors[i])));
      EXPECT_LE(largest, threshold) << noise;
      EXPECT_GT(largest, threshold / 4) << noise;
      // Less than one block a color.
      EXPECT_LT(encoded.size.bytes(), 8 * colors.size());
    }
}

TEST(Dolonius, ALargerThresholdTakesFewerBytes) {
  const Colors colors = smooth_colors(16384, 6, 5);
  std::uint64_t before = 8 * colors.size();
  for (const float threshold : {0.02f, 0.05f, 0.1f, 0.3f}) {
    const std::uint64_t size = encode_dolonius(colors, threshold, Progress()).size.bytes();
    EXPECT_LT(size, before);
    before = size;
  }
}

// Greedy merges are at most as good as the best of all cuts into blocks.
TEST(Dolonius, ACutIsNeverBetterThanTheBest) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    const Colors bytes_list = smooth_colors(60, static_cast<int>(1 + seed * 5), seed);
    std::vector<Vec3f> colors;
    for (const ColorBytes color : bytes_list) colors.push_back(color_of_bytes(color));
    std::vector<std::uint64_t> best{0};
    for (std::size_t end = 1; end <= colors.size(); ++end) {
      std::uint64_t least = ~std::uint64_t{0};
      for (std::size_t begin = 0; begin < end; ++begin)
        for (int bits = 0; bits <= kMaxWeightBits; ++bits)
          if (line_score(std::span(colors).subspan(begin, end - begin), bits, 0.05f) >= 0)
            least = std::min(least, best[begin] + 64 + static_cast<unsigned>(bits) * (end - begin));
      best.push_back(least);
    }
    const EncodedColors encoded = encode_dolonius(bytes_list, 0.05f, Progress());
    const std::uint64_t bits = 8 * (part(encoded, "block headers") + part(encoded, "end points") +
                                    part(encoded, "weights"));
    EXPECT_GE(bits, best.back()) << seed;
    EXPECT_LE(bits, 2 * best.back() + 32) << seed;
  }
}

TEST(ColorLine, EndPointsOfTwoColorsAreTheColors) {
  const std::vector<Vec3f> colors{{0, 0, 0}, {1, 0, 1}};
  const ColorLine line = fit_line(colors, 2);
  EXPECT_EQ(line.a, colors[0]);
  EXPECT_EQ(line.b, colors[1]);
  EXPECT_EQ(line.weight_of({0.7f, 0, 0.6f}), 2);
  EXPECT_EQ(fit_line(colors, 0).weight_of({1, 0, 1}), 0);
}

TEST(ColorLine, BytesKeepTheirColor) {
  for (ColorBytes color : {bytes(1, 2, 3), bytes(255, 0, 128), bytes(0, 0, 0)})
    EXPECT_EQ(bytes_of_color(color_of_bytes(color)), color);
  EXPECT_EQ(bytes_of_color({2, -1, 0.5f}), bytes(255, 0, 128));
}

}  // namespace
}  // namespace voxdag::lab
